// Operators packs are deflated, and the solver's module has no inflater: the browser has one.

// Four letters, version and length stand before the body (crates/face/src/pack/envelope.rs).
const HEAD = 12;

/// The pack with its body inflated, or a thrown Error if it is damaged.
export async function inflated(pack) {
  if (pack.length < HEAD) return pack;
  const body = new Blob([pack.subarray(HEAD)]).stream().pipeThrough(new DecompressionStream("deflate"));
  const bytes = await new Response(body).arrayBuffer().catch((error) => {
    throw new Error(`MMOP pack: the body cannot be inflated (${error.message}); load the page again`);
  });
  const whole = new Uint8Array(HEAD + bytes.byteLength);
  whole.set(pack.subarray(0, HEAD));
  whole.set(new Uint8Array(bytes), HEAD);
  return whole;
}
