//! The control cage's connectivity: a quilt of rows and columns round the head, closed by a cap on
//! the skull, with rectangular holes that are filled by edge loops round the eyes, the mouth, the
//! nostrils and the ears. Every hole's corner is a pole of valence five, as in hand-made heads.

use std::collections::BTreeMap;
use std::collections::BTreeSet;

/// Columns round the head: 0 is the front midline, positive ones are on the person's left.
pub(crate) const COLUMNS: i32 = 48;
/// Rows from the hair line (0) to the bottom of the neck.
pub(crate) const ROWS: i32 = 29;
/// Cells along each side of the cap on the skull; four sides make one row.
pub(crate) const CAP: i32 = COLUMNS / 4;

/// What fills a hole of the quilt.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Feature {
    Mouth,
    EyeLeft,
    EyeRight,
    NostrilLeft,
    NostrilRight,
    EarLeft,
    EarRight,
}

impl Feature {
    pub(crate) const ALL: [Feature; 7] = [
        Feature::Mouth,
        Feature::EyeLeft,
        Feature::EyeRight,
        Feature::NostrilLeft,
        Feature::NostrilRight,
        Feature::EarLeft,
        Feature::EarRight,
    ];

    pub(crate) fn mirrored(self) -> Feature {
        match self {
            Feature::Mouth => Feature::Mouth,
            Feature::EyeLeft => Feature::EyeRight,
            Feature::EyeRight => Feature::EyeLeft,
            Feature::NostrilLeft => Feature::NostrilRight,
            Feature::NostrilRight => Feature::NostrilLeft,
            Feature::EarLeft => Feature::EarRight,
            Feature::EarRight => Feature::EarLeft,
        }
    }

    /// First row, last row, first column, last column of the hole's boundary.
    pub(crate) fn block(self) -> (i32, i32, i32, i32) {
        match self {
            Feature::Mouth => (15, 19, -5, 5),
            Feature::EyeLeft => (4, 8, 3, 9),
            Feature::EyeRight => (4, 8, -9, -3),
            Feature::NostrilLeft => (12, 14, 1, 3),
            Feature::NostrilRight => (12, 14, -3, -1),
            Feature::EarLeft => (6, 12, 14, 18),
            Feature::EarRight => (6, 12, -18, -14),
        }
    }

    /// Loops inside the boundary.
    pub(crate) fn rings(self) -> i32 {
        match self {
            Feature::Mouth => MOUTH_RINGS,
            Feature::EyeLeft | Feature::EyeRight => EYE_RINGS,
            Feature::NostrilLeft | Feature::NostrilRight => NOSTRIL_RINGS,
            Feature::EarLeft | Feature::EarRight => EAR_RINGS,
        }
    }

    /// Whether the innermost loop is filled (an ear's conch, a nostril, the throat) or open (lids).
    fn capped(self) -> bool {
        !matches!(self, Feature::EyeLeft | Feature::EyeRight)
    }

    /// Vertices along a loop.
    pub(crate) fn ring_length(self) -> i32 {
        let (r0, r1, c0, c1) = self.block();
        2 * (r1 - r0 + c1 - c0)
    }

    /// Grid address of boundary vertex `k`, clockwise from the top left as seen from outside.
    pub(crate) fn boundary(self, k: i32) -> (i32, i32) {
        let (r0, r1, c0, c1) = self.block();
        let (h, w) = (r1 - r0, c1 - c0);
        let k = k.rem_euclid(2 * (h + w));
        if k < w {
            (r0, c0 + k)
        } else if k < w + h {
            (r0 + k - w, c1)
        } else if k < 2 * w + h {
            (r1, c1 - (k - w - h))
        } else {
            (r1 - (k - 2 * w - h), c0)
        }
    }
}

/// Loops round the mouth, the last three lining it.
pub(crate) const MOUTH_RINGS: i32 = 10;
/// Loop of the mouth from which the lining is the socket, no longer skin.
pub(crate) const MOUTH_SOCKET_FROM: i32 = 8;
/// Loops round an eye.
pub(crate) const EYE_RINGS: i32 = 7;
/// Loops round a nostril.
pub(crate) const NOSTRIL_RINGS: i32 = 3;
/// Loops round an ear.
pub(crate) const EAR_RINGS: i32 = 8;

/// The address of a cage vertex. Ring 1 is the first loop inside a hole's boundary.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Site {
    /// Row and signed column (-23 ..= 24) of the quilt.
    Grid(i32, i32),
    /// Column and row of the cap, from the left front corner.
    Cap(i32, i32),
    /// Feature, ring, index along it.
    Ring(Feature, i32, i32),
    /// Feature, row and column inside the fill of the innermost loop.
    Fill(Feature, i32, i32),
}

/// The cage: addresses, quads, mirror pairs.
pub(crate) struct Topology {
    pub sites: Vec<Site>,
    pub quads: Vec<[u32; 4]>,
    /// True for quads that line the mouth.
    pub quad_is_socket: Vec<bool>,
    /// The vertex on the other side of the face; midline vertices are their own.
    pub mirror: Vec<u32>,
    index: BTreeMap<Site, u32>,
}

impl Topology {
    /// Vertices of the skin when each of its quads is split in `across x across`.
    pub(crate) fn skin_vertices(&self, across: usize) -> usize {
        let skin = || self.quads.iter().zip(&self.quad_is_socket).filter(|q| !q.1).map(|q| q.0);
        let corners: BTreeSet<u32> = skin().flatten().copied().collect();
        let sides = |q: &[u32; 4]| [0, 1, 2, 3].map(|k| (q[k], q[(k + 1) % 4]));
        let edges: BTreeSet<(u32, u32)> =
            skin().flat_map(sides).map(|(a, b)| (a.min(b), a.max(b))).collect();
        corners.len() + edges.len() * (across - 1) + skin().count() * (across - 1) * (across - 1)
    }

    pub(crate) fn new() -> Topology {
        let mut t = Topology {
            sites: Vec::new(),
            quads: Vec::new(),
            quad_is_socket: Vec::new(),
            mirror: Vec::new(),
            index: BTreeMap::new(),
        };
        for r in 0..ROWS - 1 {
            for c in 0..COLUMNS {
                let (c0, c1) = (signed(c), signed(c + 1));
                if Feature::ALL.iter().any(|f| in_block(*f, r, c0, c1)) {
                    continue;
                }
                let corners = [(r, c0), (r + 1, c0), (r + 1, c1), (r, c1)];
                t.quad(corners.map(|(r, c)| Site::Grid(r, c)), false);
            }
        }
        for i in 0..CAP {
            for j in 0..CAP {
                t.quad([cap(i, j), cap(i + 1, j), cap(i + 1, j + 1), cap(i, j + 1)], false);
            }
        }
        for feature in Feature::ALL {
            t.add_feature(feature);
        }
        t.mirror = t.sites.iter().map(|&s| t.index[&mirrored(s)]).collect();
        t
    }

    fn add_feature(&mut self, feature: Feature) {
        let n = feature.ring_length();
        for ring in 0..feature.rings() {
            let socket = feature == Feature::Mouth && ring >= MOUTH_SOCKET_FROM;
            for k in 0..n {
                let loop_site = |ring, k| ring_site(feature, ring, k);
                let corners = [(ring, k), (ring + 1, k), (ring + 1, k + 1), (ring, k + 1)];
                self.quad(corners.map(|(ring, k)| loop_site(ring, k)), socket);
            }
        }
        if feature.capped() {
            let (r0, r1, c0, c1) = feature.block();
            let (h, w) = (r1 - r0, c1 - c0);
            for i in 0..h {
                for j in 0..w {
                    let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
                    let socket = feature == Feature::Mouth;
                    self.quad(corners.map(|(i, j)| fill_site(feature, i, j)), socket);
                }
            }
        }
    }

    fn quad(&mut self, sites: [Site; 4], socket: bool) {
        let quad = sites.map(|site| {
            *self.index.entry(site).or_insert_with(|| {
                self.sites.push(site);
                (self.sites.len() - 1) as u32
            })
        });
        self.quads.push(quad);
        self.quad_is_socket.push(socket);
    }

    /// Vertex at an address that is known to exist.
    pub(crate) fn at(&self, site: Site) -> usize {
        self.index[&site] as usize
    }

    /// Vertex of ring `ring` (0 = the hole's boundary) at index `k`, which wraps.
    pub(crate) fn ring(&self, feature: Feature, ring: i32, k: i32) -> usize {
        self.at(ring_site(feature, ring, k))
    }
}

/// Column number -23 ..= 24 of a column counted on from the front.
pub(crate) fn signed(c: i32) -> i32 {
    let c = c.rem_euclid(COLUMNS);
    if c <= COLUMNS / 2 { c } else { c - COLUMNS }
}

fn in_block(feature: Feature, row: i32, c0: i32, c1: i32) -> bool {
    let (r0, r1, b0, b1) = feature.block();
    row >= r0 && row < r1 && c0 >= b0 && c1 <= b1 && c1 > c0
}

fn cap(i: i32, j: i32) -> Site {
    let half = CAP / 2;
    let column = if j == 0 {
        i - half
    } else if i == CAP {
        half + j
    } else if j == CAP {
        half + CAP + (CAP - i)
    } else if i == 0 {
        -half - j
    } else {
        return Site::Cap(i, j);
    };
    Site::Grid(0, signed(column))
}

fn ring_site(feature: Feature, ring: i32, k: i32) -> Site {
    if ring == 0 {
        let (r, c) = feature.boundary(k);
        Site::Grid(r, c)
    } else {
        Site::Ring(feature, ring, k.rem_euclid(feature.ring_length()))
    }
}

/// Address inside the fill: its border is the innermost ring, numbered as the hole's boundary is.
fn fill_site(feature: Feature, i: i32, j: i32) -> Site {
    let (r0, r1, c0, c1) = feature.block();
    let (h, w) = (r1 - r0, c1 - c0);
    let k = if i == 0 {
        j
    } else if j == w {
        w + i
    } else if i == h {
        w + h + (w - j)
    } else if j == 0 {
        2 * w + h + (h - i)
    } else {
        return Site::Fill(feature, i, j);
    };
    ring_site(feature, feature.rings(), k)
}

fn mirrored(site: Site) -> Site {
    match site {
        Site::Grid(r, c) => Site::Grid(r, signed(-c)),
        Site::Cap(i, j) => Site::Cap(CAP - i, j),
        Site::Ring(f, ring, k) => {
            let (_, _, c0, c1) = f.block();
            Site::Ring(f.mirrored(), ring, (c1 - c0 - k).rem_euclid(f.ring_length()))
        }
        Site::Fill(f, i, j) => {
            let (_, _, c0, c1) = f.block();
            Site::Fill(f.mirrored(), i, c1 - c0 - j)
        }
    }
}
