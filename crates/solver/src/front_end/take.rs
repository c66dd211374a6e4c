//! From captured markers to displacements of the avatar's marker vertices (thesis 5.2.1-5.2.2):
//! head, neutral, alignment, adaptation.

use std::ops::Range;

use mimique_geometry::{Point, RigidMotion, align_rigidly, centroid};

use crate::front_end::error::{FrontEndError, equal};
use crate::front_end::head_pose::{head_poses, head_reference};
use crate::front_end::lowpass::Lowpass;
use crate::front_end::marker_frames::{MarkerColumns, MarkerFrames, check_columns, point};
use crate::front_end::marker_scales::MarkerScales;
use crate::front_end::rbf::Rbf;
use crate::front_end::surface_depth::SurfaceDepth;

/// The front end of one take and one avatar: fitted once, then a frame at a time.
#[derive(Debug, Clone, PartialEq)]
pub struct FrontEnd {
    columns: MarkerColumns,
    head_reference: Vec<Point>,
    neutral: Vec<Point>,
    avatar_markers: Vec<Point>,
    avatar_from_actor: RigidMotion,
    rbf: Rbf,
    /// Where the neutral face is when it is adapted: displacements begin here.
    rest: Vec<Point>,
    depth: Option<SurfaceDepth>,
    smoothing: f64,
    scales: Option<MarkerScales>,
}

/// How an actor's markers are carried over to the avatar's shape.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Adaptation {
    /// What gives a two-dimensional capture its depth: x and y are measured, z is not looked at, and comes
    /// back with the displacements.
    pub depth: Option<SurfaceDepth>,
    /// Smoothing of the radial basis functions ([`Rbf::smooth`]); 0 meets every marker.
    pub smoothing: f64,
}

/// Memory that a frame needs, kept between frames.
#[derive(Debug, Clone, Default)]
pub struct FrontEndScratch {
    points: [Vec<f64>; 3],
    adapted: [Vec<f64>; 3],
}

impl FrontEnd {
    /// Fit to a take: head reference from its first frame, neutral M0 from the mean of the
    /// stabilised neutral frames (60 or more), alignment and RBF from M0 to the avatar's marker
    /// positions.
    ///
    /// `poses` are of [`FrontEnd::head_poses`], for the same frames.
    ///
    /// # Errors
    /// [`FrontEndError`], naming the frame or marker.
    pub fn fit(
        take: MarkerFrames<'_>,
        columns: &MarkerColumns,
        poses: &[RigidMotion],
        neutral: Range<usize>,
        avatar_markers: &[Point],
    ) -> Result<FrontEnd, FrontEndError> {
        let adaptation = Adaptation::default();
        FrontEnd::fit_with(take, columns, poses, neutral, avatar_markers, adaptation)
    }

    /// The same with an adaptation of its own.
    ///
    /// # Errors
    /// As [`FrontEnd::fit`].
    pub fn fit_with(
        take: MarkerFrames<'_>,
        columns: &MarkerColumns,
        poses: &[RigidMotion],
        neutral: Range<usize>,
        avatar_markers: &[Point],
        adaptation: Adaptation,
    ) -> Result<FrontEnd, FrontEndError> {
        check_columns(take, columns)?;
        let frames = take.len();
        equal("head poses", poses.len(), frames)?;
        let Range { start, end } = neutral;
        if start >= end || end > frames {
            return Err(FrontEndError::NeutralRange { start, end, frames });
        }
        let neutral = (columns.face.iter().enumerate())
            .map(|(marker, &column)| {
                let seen = (start..end)
                    .map(|frame| (frame, point(take.frame(frame), column)))
                    .filter(|(_, p)| p.is_seen());
                let mean = centroid(seen.map(|(frame, p)| poses[frame].apply(p)));
                if mean.is_seen() { Ok(mean) } else { Err(FrontEndError::NeutralUnseen { marker }) }
            })
            .collect::<Result<Vec<Point>, FrontEndError>>()?;
        let reference = head_reference(take, columns);
        let avatar_markers = avatar_markers.to_vec();
        FrontEnd::from_parts(columns.clone(), reference, neutral, avatar_markers, adaptation)
    }

    /// Take up a stored head reference and neutral: what a segment of a take needs to be solved
    /// by itself, with the same bits.
    ///
    /// `head_reference` has a point for each head column (empty without head), `neutral` and
    /// `avatar_markers` one for each face column.
    ///
    /// # Errors
    /// [`FrontEndError`] where sizes disagree, or the neutral cannot be laid onto the avatar.
    pub fn from_neutral(
        columns: MarkerColumns,
        head_reference: Vec<Point>,
        neutral: Vec<Point>,
        avatar_markers: Vec<Point>,
    ) -> Result<FrontEnd, FrontEndError> {
        let adaptation = Adaptation::default();
        FrontEnd::from_parts(columns, head_reference, neutral, avatar_markers, adaptation)
    }

    /// The same with an adaptation of its own.
    ///
    /// Where there is a depth, in the image M0 is turned and shifted onto the avatar's markers; each marker then has the
    /// depth of its place on the avatar while the adaptation of shape is computed, as the mask of
    /// 4.3.1 is laid onto the face, and dz follows from the surface.
    ///
    /// # Errors
    /// As [`FrontEnd::from_neutral`].
    pub fn from_parts(
        columns: MarkerColumns,
        head_reference: Vec<Point>,
        neutral: Vec<Point>,
        avatar_markers: Vec<Point>,
        Adaptation { depth, smoothing }: Adaptation,
    ) -> Result<FrontEnd, FrontEndError> {
        let p = columns.face.len();
        equal("neutral markers", neutral.len(), p)?;
        equal("markers on the avatar", avatar_markers.len(), p)?;
        let heads = columns.head.as_ref().map_or(0, Vec::len);
        equal("head reference points", head_reference.len(), heads)?;
        let (avatar_from_actor, aligned) = match &depth {
            None => {
                let motion =
                    align_rigidly(&neutral, &avatar_markers).map_err(FrontEndError::Alignment)?;
                (motion, neutral.iter().map(|&p| motion.apply(p)).collect::<Vec<_>>())
            }
            Some(depth) => {
                equal("markers with a depth", depth.fans.len(), p)?;
                let flat = |p: &Point| Point::new(p.x, p.y, 0.0);
                let in_image = |points: &[Point]| points.iter().map(flat).collect::<Vec<Point>>();
                let motion = align_rigidly(&in_image(&neutral), &in_image(&avatar_markers))
                    .map_err(FrontEndError::Alignment)?;
                let lifted = |(p, avatar): (&Point, &Point)| {
                    let moved = motion.apply(flat(p));
                    Point::new(moved.x, moved.y, avatar.z)
                };
                (motion, neutral.iter().zip(&avatar_markers).map(lifted).collect())
            }
        };
        let rbf = Rbf::smooth(&aligned, &avatar_markers, smoothing)?;
        // A smooth function misses its values: the neutral face is at rest where it goes, not where it should.
        let rest = match smoothing == 0.0 {
            true => avatar_markers.clone(),
            false => aligned.iter().map(|&p| rbf.apply(p)).collect(),
        };
        Ok(FrontEnd {
            columns,
            head_reference,
            neutral,
            avatar_markers,
            avatar_from_actor,
            rbf,
            rest,
            depth,
            smoothing,
            scales: None,
        })
    }

    /// The same with displacements scaled (Kouadio 5.3).
    ///
    /// # Errors
    /// [`FrontEndError::Size`] unless there are factors for each face marker.
    pub fn with_scales(mut self, scales: Option<MarkerScales>) -> Result<FrontEnd, FrontEndError> {
        if let Some(scales) = &scales {
            let p = self.columns.face.len();
            equal("scale factors", scales.positive.len(), p)?;
            equal("scale factors", scales.negative.len(), p)?;
        }
        self.scales = scales;
        Ok(self)
    }

    /// The factors of the displacements, if they are scaled.
    pub fn scales(&self) -> Option<&MarkerScales> {
        self.scales.as_ref()
    }

    /// What gives a two-dimensional capture its depth.
    pub fn depth(&self) -> Option<&SurfaceDepth> {
        self.depth.as_ref()
    }

    /// How the markers are carried over, to fit another front end in the same way.
    pub fn adaptation(&self) -> Adaptation {
        Adaptation { depth: self.depth.clone(), smoothing: self.smoothing }
    }

    /// The columns that it was fitted with.
    pub fn columns(&self) -> &MarkerColumns {
        &self.columns
    }

    /// The head markers in the first frame, metres.
    pub fn head_reference(&self) -> &[Point] {
        &self.head_reference
    }

    /// M0: the stabilised neutral face markers, metres, in the capture's axes.
    pub fn neutral(&self) -> &[Point] {
        &self.neutral
    }

    /// The rigid motion from the actor's neutral onto the avatar.
    pub fn avatar_from_actor(&self) -> &RigidMotion {
        &self.avatar_from_actor
    }

    /// The adaptation of shape, from aligned actor to avatar.
    pub fn rbf(&self) -> &Rbf {
        &self.rbf
    }

    /// For each frame the motion that takes the head back to where it was in the reference frame.
    ///
    /// `lowpass` smooths the pose over time (zero phase); head noise is otherwise the largest part
    /// of the noise of the face markers.
    ///
    /// # Errors
    /// [`FrontEndError::Head`] naming the first frame with fewer than three good head markers or
    /// with all of them in a line. A good head marker is seen in the frame and in the reference.
    pub fn head_poses(
        take: MarkerFrames<'_>,
        columns: &MarkerColumns,
        lowpass: Option<&Lowpass>,
    ) -> Result<Vec<RigidMotion>, FrontEndError> {
        check_columns(take, columns)?;
        head_poses(take, columns, &head_reference(take, columns), lowpass)
    }

    /// The same with this front end's own head reference, for the frames of one segment.
    ///
    /// # Errors
    /// As [`FrontEnd::head_poses`].
    pub fn segment_poses(
        &self,
        take: MarkerFrames<'_>,
        lowpass: Option<&Lowpass>,
    ) -> Result<Vec<RigidMotion>, FrontEndError> {
        check_columns(take, &self.columns)?;
        head_poses(take, &self.columns, &self.head_reference, lowpass)
    }

    /// d = RBF(M) - avatar markers of one frame, eq. 5.21 (with smoothing RBF(M) - RBF(M0): the neutral face
    /// is at rest), with depth and scale factors where there are some: 3P numbers, metres; NaN for a marker
    /// that is not seen. Allocates nothing after the first call with a scratch.
    ///
    /// # Panics
    /// If `frame` or `out` is too short.
    pub fn displacements(
        &self,
        pose: &RigidMotion,
        frame: &[f64],
        out: &mut [f64],
        scratch: &mut FrontEndScratch,
    ) {
        let p = self.columns.face.len();
        for axis in scratch.points.iter_mut().chain(&mut scratch.adapted) {
            axis.resize(p, 0.0);
        }
        let motion = self.avatar_from_actor.after(pose);
        for (marker, &column) in self.columns.face.iter().enumerate() {
            let mut moved = motion.apply(point(frame, column));
            if self.depth.is_some() {
                moved.z = self.avatar_markers[marker].z;
            }
            for a in 0..3 {
                scratch.points[a][marker] = moved[a];
            }
        }
        let [px, py, pz] = &mut scratch.points;
        let [ox, oy, oz] = &mut scratch.adapted;
        self.rbf.apply_all([px, py, pz], [ox, oy, oz]);
        for (marker, rest) in self.rest.iter().enumerate() {
            for a in 0..3 {
                out[3 * marker + a] = scratch.adapted[a][marker] - rest[a];
            }
        }
        if let Some(depth) = &self.depth {
            for (marker, d) in out.chunks_exact_mut(3).enumerate().take(p) {
                d[2] = depth.depth(marker, [d[0], d[1]]);
            }
        }
        if let Some(scales) = &self.scales {
            scales.apply(out);
        }
    }

    /// d of every frame: frames x 3P, metres.
    ///
    /// # Errors
    /// [`FrontEndError::Size`] where poses and frames disagree.
    pub fn take_displacements(
        &self,
        take: MarkerFrames<'_>,
        poses: &[RigidMotion],
    ) -> Result<Vec<f64>, FrontEndError> {
        check_columns(take, &self.columns)?;
        equal("head poses", poses.len(), take.len())?;
        let width = 3 * self.columns.face.len();
        let mut out = vec![0.0; take.len() * width];
        let mut scratch = FrontEndScratch::default();
        for (frame, (pose, out)) in poses.iter().zip(out.chunks_exact_mut(width)).enumerate() {
            self.displacements(pose, take.frame(frame), out, &mut scratch);
        }
        Ok(out)
    }
}
