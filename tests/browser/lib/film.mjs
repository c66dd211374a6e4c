// A film for tests, made by the browser itself.

/** A film of two seconds, made by the browser itself: a disc that crosses the picture. */
export async function film(page) {
  const base64 = await page.evaluate(async () => {
    const canvas = Object.assign(document.createElement("canvas"), { width: 240, height: 240 });
    const brush = canvas.getContext("2d");
    const recorder = new MediaRecorder(canvas.captureStream(25), { mimeType: "video/webm;codecs=vp8" });
    const pieces = [];
    recorder.ondataavailable = ({ data }) => pieces.push(data);
    recorder.start();
    const began = performance.now();
    for (let ms = 0; ms < 2000; ms = performance.now() - began) {
      brush.fillStyle = "#6b4f3a";
      brush.fillRect(0, 0, 240, 240);
      brush.fillStyle = "#f2d0a0";
      brush.beginPath();
      brush.arc(20 + ms / 10, 120, 18, 0, 7);
      brush.fill();
      await new Promise((done) => setTimeout(done, 40));
    }
    await new Promise((done) => ((recorder.onstop = done), recorder.stop()));
    const bytes = new Uint8Array(await new Blob(pieces).arrayBuffer());
    return btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""));
  });
  return Buffer.from(base64, "base64");
}
