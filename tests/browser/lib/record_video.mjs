// A video for tests, made by the browser itself.

/** A video of two seconds, a frame every 30 ms: a disc that crosses the picture. */
export async function recordVideo(page) {
  const base64 = await page.evaluate(async () => {
    const canvas = Object.assign(document.createElement("canvas"), { width: 240, height: 240 });
    const brush = canvas.getContext("2d");
    // A frame is taken when one is drawn, at times that do not add up the lateness of the timers.
    const stream = canvas.captureStream(0);
    const [track] = stream.getVideoTracks();
    const recorder = new MediaRecorder(stream, { mimeType: "video/webm;codecs=vp8" });
    const pieces = [];
    recorder.ondataavailable = ({ data }) => pieces.push(data);
    recorder.start();
    const began = performance.now();
    for (let ms = 0, next = 30; ms < 2000; ms = performance.now() - began, next += 30) {
      brush.fillStyle = "#6b4f3a";
      brush.fillRect(0, 0, 240, 240);
      brush.fillStyle = "#f2d0a0";
      brush.beginPath();
      brush.arc(20 + ms / 10, 120, 18, 0, 7);
      brush.fill();
      track.requestFrame();
      await new Promise((done) => setTimeout(done, next - (performance.now() - began)));
    }
    await new Promise((done) => ((recorder.onstop = done), recorder.stop()));
    const bytes = new Uint8Array(await new Blob(pieces).arrayBuffer());
    return btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""));
  });
  return Buffer.from(base64, "base64");
}
