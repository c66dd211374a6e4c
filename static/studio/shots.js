// Pictures of a face in a chosen size: drawn on a canvas of their own, as the face is seen in its viewport.
import { openStage } from "../stage/host.js";

const BACKGROUND = "#808080";

/// A canvas for pictures of `width` by `height` pixels; `view` is the camera's. Answers {picture(clipId, timeMs), close()}.
export async function openShots({ zoom, x, y, yaw, pitch }, [width, height]) {
  // A face that was moved is drawn on a larger canvas, of which a part is taken.
  const large = 1 + 2 * Math.max(Math.abs(x), Math.abs(y));
  const ratio = globalThis.devicePixelRatio || 1;
  const canvas = document.createElement("canvas");
  const stage = await openStage(canvas, { background: BACKGROUND, width: (width * large) / ratio, height: (height * large) / ratio });
  stage.setView({ yaw, pitch, zoom: zoom / large });
  const part = () => {
    const [wide, high] = [canvas.width / large, canvas.height / large];
    return [((large - 1) / 2 - x) * wide, ((large - 1) / 2 - y) * high, wide, high].map(Math.round);
  };
  return {
    async picture(clipId, timeMs) {
      await stage.show(clipId, timeMs);
      // It must be taken in the task that drew it.
      return createImageBitmap(canvas, ...part(), { resizeWidth: width, resizeHeight: height });
    },
    close: () => stage.close(),
  };
}
