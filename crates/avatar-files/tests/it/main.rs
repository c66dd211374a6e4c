//! The integration tests of `mimique-avatar-files`, in one binary.

mod fuzz_avatars;
mod glb_write;
mod gltf_extensions;
mod gltf_made;
mod gltf_real;
mod obj_poses;
mod support;
