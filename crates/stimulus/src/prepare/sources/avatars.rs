//! The heads and videos that clips show.

use std::cell::OnceCell;
use std::rc::Rc;

use mimique_avatar::{Avatar, MOST_SHAPES};
use mimique_study::{AvatarSource, Clip, video_type};

use super::Sources;
use crate::prepare::avatar_key::avatar_key;
use crate::prepare::source_files::{AvatarFile, Video};
use crate::prepare::{PrepareError, builtin, pointer};
use crate::split_shapes;

impl<'a> Sources<'a> {
    /// The avatar of that identifier.
    pub fn avatar(&self, id: &str) -> Result<Rc<AvatarFile>, PrepareError> {
        if let Some(found) = self.avatars.borrow().get(id) {
            return found.clone();
        }
        let read = self.read_avatar(id).map(Rc::new);
        self.avatars.borrow_mut().insert(id.to_owned(), read.clone());
        read
    }

    fn read_avatar(&self, id: &str) -> Result<AvatarFile, PrepareError> {
        let at = |field: &str| pointer(&["stimuli", "avatars", id, field]);
        let source = self.study.stimuli.avatars.get(id).and_then(|a| a.source());
        let mut locked = Vec::new();
        let (key, avatar, sites, pointer) = match source {
            Some(AvatarSource::Builtin(who)) => {
                let (avatar, sites) = builtin::avatar(who);
                (avatar_key(&avatar), avatar, Some(sites), at("builtin"))
            }
            Some(AvatarSource::File(file)) => {
                let path = self.path(file, &at("file"))?;
                let read = mimique_avatar_files::read_avatar(&path).map_err(|e| {
                    PrepareError::new(at("file"), format!("{}: {e}", path.display()))
                })?;
                locked = read.locked;
                (avatar_key(&read.avatar), read.avatar, None, at("file"))
            }
            Some(AvatarSource::Videos(_)) | None => {
                let message = "give exactly one of builtin, file and videos";
                return Err(PrepareError::new(pointer(&["stimuli", "avatars", id]), message));
            }
        };
        let split = self.study.stimuli.avatars.get(id).map_or(&[][..], |a| &a.split);
        let (key, avatar) = if split.is_empty() {
            (key, avatar)
        } else {
            let avatar =
                split_shapes(&avatar, split).map_err(|e| PrepareError::new(at("split"), e))?;
            (avatar_key(&avatar), avatar)
        };
        let (key, avatar) = if self.study.shows_head_motion() {
            let avatar = with_head_pose(avatar).map_err(|e| PrepareError::new(at("file"), e))?;
            (avatar_key(&avatar), avatar)
        } else {
            (key, avatar)
        };
        Ok(AvatarFile { key, avatar, locked, sites, skin: OnceCell::new(), pointer })
    }

    /// The video that a clip shows; `None` for a clip of a head.
    pub fn video(&self, clip: &Clip) -> Result<Option<Video>, PrepareError> {
        let avatar = self.study.stimuli.avatars.get(&clip.avatar);
        let Some(AvatarSource::Videos(videos)) = avatar.and_then(|a| a.source()) else {
            return Ok(None);
        };
        let at = pointer(&["stimuli", "avatars", &clip.avatar, "videos"]);
        let path = videos.get(&clip.segment).ok_or_else(|| {
            PrepareError::new(&at, format!("no video of segment {:?}; name its file", clip.segment))
        })?;
        let at = pointer(&["stimuli", "avatars", &clip.avatar, "videos", &clip.segment]);
        let media_type = video_type(path).ok_or_else(|| {
            PrepareError::new(&at, format!("{path:?} is neither MP4 nor WebM; convert it"))
        })?;
        let (_, bytes) = self.read(path, &at)?;
        Ok(Some(Video { bytes, media_type }))
    }
}

/// An avatar with the shapes that turn its head.
fn with_head_pose(avatar: Avatar) -> Result<Avatar, String> {
    let shapes = avatar.shape_names.len();
    let turned = avatar.with_head_pose_shapes();
    if turned.shape_names.len() > MOST_SHAPES {
        return Err(format!(
            "{shapes} shapes, of which a clip shows {MOST_SHAPES} at most with those that turn the head; write \
             \"headMotion\": 0 in the captures"
        ));
    }
    Ok(turned)
}
