//! A bank of expressions held against Kouadio's five rules (4.4, 5.6): which shapes follow from
//! others, which do nothing, which no marker sees, which markers nothing moves, and whether there
//! are more unknowns than equations.

use mimique_solver::{AssociatedRows, MarkerSite, VertexAssociation, bank_columns, dead_rows};
use serde::Serialize;

use crate::AvatarSkin;

/// A shape below this at every vertex or marker moves nothing, metres.
const STILL_M: f64 = 1e-5;
/// A marker that no shape moves this far along an axis is dead in that direction, metres.
const DEAD_M: f64 = 1e-4;
/// A shape that moves no marker as far as this is hardly told from another, metres.
const SEEN_M: f64 = 1e-3;
/// Radius of the zones that equations are counted for, metres: the default of `kouadio`.
const ZONE_M: f64 = 0.012;

/// The diagnosis of an avatar's bank, on the whole skin and at the markers of a map.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BankDiagnosis {
    /// N.
    pub shapes: usize,
    /// Independent shapes on the whole skin.
    pub rank: usize,
    /// Rule 1, on the whole skin.
    pub dependent: Vec<DependentShape>,
    /// Rule 2: shapes that do not move the skin, as the neutral face does not.
    pub neutral: Vec<String>,
    /// What the markers see.
    pub at_markers: Option<MarkerDiagnosis>,
}

/// A shape that other shapes make.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DependentShape {
    /// The shape that can go.
    pub shape: String,
    /// The others and their weights.
    pub of: Vec<(String, f64)>,
    /// What they leave of it, percent of its size.
    pub left_percent: f64,
    /// Whether weights of 0 and more make it: where not (left as minus right), it stays useful in a
    /// bank whose weights are bounded.
    pub within_bounds: bool,
}

/// The bank's matrix at the markers.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MarkerDiagnosis {
    /// P.
    pub markers: usize,
    /// Independent shapes at the markers.
    pub rank: usize,
    /// Rule 1, at the markers: shapes that they cannot tell from combinations of others.
    pub dependent: Vec<DependentShape>,
    /// Rule 3: markers that no shape moves in some direction (`x`, `yz`, `xyz`).
    pub dead_markers: Vec<(String, String)>,
    /// Rule 4: shapes that move the skin and no marker.
    pub unseen: Vec<String>,
    /// Shapes that move no marker by a millimetre, with the largest motion of a marker and of the
    /// skin, millimetres.
    pub hardly_seen: Vec<(String, f64, f64)>,
    /// Rule 5: the unknowns, N less the shapes that no marker sees.
    pub unknowns: usize,
    /// Equations of the markers alone: 3P less the dead rows.
    pub equations: usize,
    /// Equations of all points within 12 mm of a marker, and of all over the markers' triangles.
    pub equations_of_zones: usize,
    /// The same of the points over the triangles between markers.
    pub equations_of_triangles: usize,
}

impl BankDiagnosis {
    /// Of a skin, and of the markers on it where there are some.
    pub fn of(skin: &AvatarSkin, sites: Option<&[MarkerSite]>) -> BankDiagnosis {
        let n = skin.shape_names.len();
        // The skin's rows that a shape moves: 3 per vertex.
        let mut moved = vec![false; skin.mesh.positions.len()];
        for shape in &skin.mesh.shapes {
            shape.vertices.iter().for_each(|&v| moved[v as usize] = true);
        }
        let mut row_of = vec![0; moved.len()];
        let mut rows = 0;
        for (row, moved) in row_of.iter_mut().zip(&moved) {
            *row = rows;
            rows += 3 * usize::from(*moved);
        }
        let mut bank = vec![0.0; rows * n];
        for (k, shape) in skin.mesh.shapes.iter().enumerate() {
            for (&v, d) in shape.vertices.iter().zip(&shape.deltas) {
                for a in 0..3 {
                    bank[(row_of[v as usize] + a) * n + k] = d[a];
                }
            }
        }
        let whole = bank_columns(&bank, n, STILL_M);
        let name = |k: &usize| skin.shape_names[*k].clone();
        BankDiagnosis {
            shapes: n,
            rank: whole.rank,
            dependent: named(&skin.shape_names, &whole.dependent),
            neutral: whole.zero.iter().map(name).collect(),
            at_markers: sites.map(|sites| MarkerDiagnosis::of(skin, sites, &whole.zero)),
        }
    }

    /// Whether every rule is kept (combinations that need weights below 0 do not count).
    pub fn is_clean(&self) -> bool {
        let clean = |list: &[DependentShape]| list.iter().all(|d| !d.within_bounds);
        let markers = self.at_markers.as_ref().is_none_or(|m| {
            clean(&m.dependent)
                && m.dead_markers.is_empty()
                && m.unseen.is_empty()
                && m.unknowns < m.equations
        });
        clean(&self.dependent) && self.neutral.is_empty() && markers
    }

    /// The diagnosis for people: a paragraph a rule.
    pub fn text(&self) -> String {
        let mut out = format!("rank: {} of {} shapes on the skin\n", self.rank, self.shapes);
        let mut rule = |number: u32, what: &str, found: Vec<String>| {
            if found.is_empty() {
                out.push_str(&format!("rule {number}: {what}: none\n"));
            } else {
                out.push_str(&format!("rule {number}: {what}:\n"));
                found.iter().for_each(|line| out.push_str(&format!("  {line}\n")));
            }
        };
        let combinations =
            |list: &[DependentShape]| list.iter().map(DependentShape::text).collect();
        rule(1, "shapes that others make, on the skin", combinations(&self.dependent));
        if let Some(m) = &self.at_markers {
            rule(1, "shapes that others make, as the markers see them", combinations(&m.dependent));
        }
        rule(2, "shapes that move nothing, as the neutral face", self.neutral.clone());
        let Some(m) = &self.at_markers else {
            out.push_str("rules 3 to 5 need the markers: give --markers MAP\n");
            return out;
        };
        let dead = m.dead_markers.iter().map(|(label, axes)| format!("{label}: {axes}"));
        rule(3, "markers that no shape moves by 0.1 mm, with the directions", dead.collect());
        rule(4, "shapes that move the skin and no marker", m.unseen.clone());
        let hardly = m.hardly_seen.iter().map(|(shape, marker, skin)| {
            format!("{shape}: {marker:.2} mm at a marker, {skin:.1} mm on the skin")
        });
        rule(4, "shapes that move no marker by 1 mm", hardly.collect());
        let verdict = if m.unknowns < m.equations { "kept" } else { "broken" };
        out.push_str(&format!(
            "rule 5: {verdict}: {} unknowns, {} equations of {} markers ({} of zones of 12 mm, {} of \
             triangles between markers); rank at the markers {}\n",
            m.unknowns,
            m.equations,
            m.markers,
            m.equations_of_zones,
            m.equations_of_triangles,
            m.rank
        ));
        out
    }
}

impl DependentShape {
    /// `jawOpen = 0.50 a + 0.49 b (0.3 % left)`.
    fn text(&self) -> String {
        let terms: Vec<String> = self.of.iter().map(|(k, x)| format!("{x:.3} {k}")).collect();
        let terms = match terms.len() {
            0..=6 => terms.join(" + "),
            more => format!("{} + {} more", terms[..6].join(" + "), more - 6),
        };
        let terms = terms.replace("+ -", "- ");
        let keep = if self.within_bounds { "" } else { "; needs a weight below 0: keep it" };
        format!("{} = {terms} ({:.2} % left{keep})", self.shape, self.left_percent)
    }
}

impl MarkerDiagnosis {
    fn of(skin: &AvatarSkin, sites: &[MarkerSite], neutral: &[usize]) -> MarkerDiagnosis {
        let n = skin.shape_names.len();
        let mut bank = vec![0.0; 3 * sites.len() * n];
        let mut at_marker = vec![0.0_f64; n];
        let mut on_skin = vec![0.0_f64; n];
        for k in 0..n {
            for (m, site) in sites.iter().enumerate() {
                let delta = site.delta(&skin.mesh, k);
                at_marker[k] = at_marker[k].max(delta.length());
                for a in 0..3 {
                    bank[(3 * m + a) * n + k] = delta[a];
                }
            }
            on_skin[k] = skin.mesh.shapes[k].deltas.iter().map(|d| d.length()).fold(0.0, f64::max);
        }
        let columns = bank_columns(&bank, n, STILL_M);
        let mut dead: Vec<(String, String)> = Vec::new();
        let rows = dead_rows(&bank, n, DEAD_M);
        for &(m, axis) in &rows {
            let (label, axis) = (sites[m].label.clone(), ["x", "y", "z"][axis]);
            match dead.last_mut() {
                Some((last, axes)) if *last == label => axes.push_str(axis),
                _ => dead.push((label, axis.to_owned())),
            }
        }
        let unseen: Vec<usize> =
            columns.zero.iter().copied().filter(|k| !neutral.contains(k)).collect();
        let hardly = (0..n).filter(|k| at_marker[*k] < SEEN_M && !columns.zero.contains(k));
        let points =
            |association| 3 * AssociatedRows::build(&skin.mesh, sites, association).vertex_count;
        MarkerDiagnosis {
            markers: sites.len(),
            rank: columns.rank,
            dependent: named(&skin.shape_names, &columns.dependent),
            dead_markers: dead,
            hardly_seen: hardly
                .map(|k| (skin.shape_names[k].clone(), 1e3 * at_marker[k], 1e3 * on_skin[k]))
                .collect(),
            unknowns: n - columns.zero.len(),
            equations: 3 * sites.len() - rows.len(),
            equations_of_zones: points(VertexAssociation::Zones { sigma: ZONE_M }),
            equations_of_triangles: points(VertexAssociation::Triangles),
            unseen: unseen.iter().map(|&k| skin.shape_names[k].clone()).collect(),
        }
    }
}

fn named(names: &[String], combinations: &[mimique_solver::Combination]) -> Vec<DependentShape> {
    (combinations.iter())
        .map(|c| DependentShape {
            shape: names[c.shape].clone(),
            of: c.of.iter().map(|&(k, x)| (names[k].clone(), x)).collect(),
            left_percent: 100.0 * c.left,
            within_bounds: c.of.iter().all(|(_, x)| *x >= 0.0),
        })
        .collect()
}
