//! An export as the body of an answer, which is sent while it is made.

use axum::body::{Body, Bytes};
use tokio::sync::mpsc;
use tokio_stream::wrappers::ReceiverStream;

use super::error::ExportError;
use super::exported::psych_ds_folder;
use super::parts::{Export, Part};
use super::zipped::Zipped;

impl Export {
    /// The name of the file that [`Self::into_body`] gives.
    pub(crate) fn download_name(&self) -> String {
        if self.format().is_folder() {
            format!("{}.zip", psych_ds_folder(self.study_id()))
        } else {
            self.main_file()
        }
    }

    /// The body of an answer: the file, or a ZIP archive of several.
    pub(crate) fn into_body(mut self) -> Body {
        let (sender, receiver) = mpsc::channel::<Result<Bytes, ExportError>>(1);
        tokio::spawn(async move {
            let folder = psych_ds_folder(self.study_id());
            let mut zipped = self.format().is_folder().then(|| Zipped::below(&folder));
            loop {
                let piece = next(&mut self, &mut zipped).await;
                let Some(piece) = piece.transpose() else { break };
                if let Err(error) = &piece {
                    tracing::error!("an export broke off: {error}");
                }
                let is_over = piece.is_err();
                // Whoever has gone wants no more of it.
                if sender.send(piece).await.is_err() || is_over {
                    break;
                }
            }
        });
        Body::from_stream(ReceiverStream::new(receiver))
    }
}

/// The next piece of the body; none at the end.
async fn next(
    export: &mut Export,
    zipped: &mut Option<Zipped>,
) -> Result<Option<Bytes>, ExportError> {
    loop {
        let part = export.next().await?;
        let bytes = match (part, &mut *zipped) {
            (None, _) => {
                let rest = zipped.take().map(Zipped::finish).transpose()?;
                return Ok(rest.map(Bytes::from));
            }
            (Some(part), Some(zipped)) => {
                zipped.take(part)?;
                zipped.made()
            }
            (Some(Part::Bytes(bytes)), None) => bytes,
            (Some(Part::File(_)), None) => continue,
        };
        if !bytes.is_empty() {
            return Ok(Some(bytes.into()));
        }
    }
}
