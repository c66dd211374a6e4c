// Measures faces off the page's thread: pictures in, 52 numbers each out. What measures (MediaPipe's Face Landmarker) is
// what the study brings. A picture is closed as soon as it is measured; none leaves this worker.

let landmarker = null;
let shapes = [];

const begin = async ({ bundle, loader, module, model, shapes: names }) => {
  shapes = names;
  const { FaceLandmarker } = await import(bundle);
  // The processor, not the graphics card, which draws the clip meanwhile.
  landmarker = await FaceLandmarker.createFromOptions(
    { wasmLoaderPath: loader, wasmBinaryPath: module },
    {
      baseOptions: { modelAssetBuffer: model, delegate: "CPU" },
      runningMode: "VIDEO",
      numFaces: 1,
      outputFaceBlendshapes: true,
      outputFacialTransformationMatrixes: false,
    },
  );
};

// Scores in thousandths in the order of `shapes`; none where there is no face.
const measured = (picture, atMs) => {
  const [face] = landmarker.detectForVideo(picture, atMs).faceBlendshapes ?? [];
  if (!face) return [];
  const scores = new Map(face.categories.map(({ categoryName, score }) => [categoryName, score]));
  return shapes.map((name) => Math.round(1000 * Math.min(Math.max(scores.get(name) ?? 0, 0), 1)));
};

globalThis.onmessage = async ({ data }) => {
  if (data.begin) {
    await begin(data.begin).then(
      () => postMessage({ ready: true }),
      (error) => postMessage({ failed: String(error?.message ?? error) }),
    );
    return;
  }
  const { picture, atMs } = data;
  try {
    postMessage({ atMs, scores: measured(picture, atMs) });
  } catch (error) {
    postMessage({ failed: String(error?.message ?? error) });
  } finally {
    picture.close();
  }
};
