//! What joins avatar, capture and method: marker maps, the solve of a take, weight files, packs, provenance.
