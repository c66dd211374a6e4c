// A video for tests, made by the browser itself.

/**
 * A video of about two seconds, a frame every 30 ms: a disc that crosses the picture. `{bytes, durationMs}`: a busy machine
 * records less of it.
 */
export async function recordVideo(page) {
  const { base64, durationMs } = await page.evaluate(async () => {
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
    const blob = new Blob(pieces);
    const bytes = new Uint8Array(await blob.arrayBuffer());
    const video = Object.assign(document.createElement("video"), { src: URL.createObjectURL(blob) });
    await new Promise((done) => (video.onloadeddata = done));
    // What a browser records does not say how long it is: its end does.
    await new Promise((done) => ((video.onseeked = done), (video.currentTime = 1e6)));
    const durationMs = video.currentTime * 1000;
    return { base64: btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join("")), durationMs };
  });
  return { bytes: Buffer.from(base64, "base64"), durationMs };
}
