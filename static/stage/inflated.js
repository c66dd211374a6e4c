// Operators packs are deflated, and the solver's module has no inflater: the browser has one.

// Four letters, version and length stand before the body (crates/avatar/src/pack/envelope.rs).
const HEAD = 12;
const KIND = [..."MMOP"].map((letter) => letter.charCodeAt(0));

/// The pack with its body inflated, or a thrown Error if it is damaged. Bytes that are not an operators pack come back
/// as they are: clips of recorded weights have none, and the solver says so where it needs one.
export async function inflated(pack) {
  if (pack.length < HEAD || KIND.some((letter, at) => pack[at] !== letter)) return pack;
  const body = new Blob([pack.subarray(HEAD)]).stream().pipeThrough(new DecompressionStream("deflate"));
  const bytes = await new Response(body).arrayBuffer().catch((error) => {
    throw new Error(`MMOP pack: the body cannot be inflated (${error.message}); load the page again`);
  });
  const whole = new Uint8Array(HEAD + bytes.byteLength);
  whole.set(pack.subarray(0, HEAD));
  whole.set(new Uint8Array(bytes), HEAD);
  return whole;
}
