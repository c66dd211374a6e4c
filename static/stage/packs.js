// Packs by hash: fetched once, checked, kept. Lost connections are tried again.
import { failureOf, StageFailure } from "./failure.js";

const TRIES = 5;
// A connection that brings nothing for so long is given up and tried anew.
const STALL_MS = 15_000;

const packs = new Map();

// Another place that holds the packs by their hash, if this server names one. What comes from there
// is checked like everything else; where it fails, the server itself is asked.
const elsewhere = globalThis.document?.querySelector('meta[name="mimique-packs"]')?.content || "/packs";

/// The bytes of a pack. `onBytes(count)` is told of every piece that arrives; a try that fails
/// takes its pieces back with a negative count. `folder`: the address of a folder that alone is asked.
export function fetchPack(hash, onBytes = () => {}, folder = "") {
  let kept = packs.get(hash);
  if (!kept) {
    kept = { listeners: new Set(), received: 0 };
    const tell = (count) => {
      kept.received += count;
      for (const listener of kept.listeners) listener(count);
    };
    kept.bytes = fetchWithRetry(hash, tell, folder ? [folder] : [elsewhere, "/packs"]);
    // A pack that could not be had is asked for again the next time.
    kept.bytes.catch(() => packs.delete(hash));
    packs.set(hash, kept);
  }
  onBytes(kept.received);
  kept.listeners.add(onBytes);
  return kept.bytes.finally(() => kept.listeners.delete(onBytes));
}

async function fetchWithRetry(hash, tell, places) {
  let reason;
  for (let attempt = 0; attempt < TRIES; attempt++) {
    if (attempt > 0) await pause(Math.min(500 * 2 ** (attempt - 1), 8000));
    let received = 0;
    try {
      return await fetchOnce(`${places[attempt % places.length]}/${hash}`, hash, (count) => {
        received += count;
        tell(count);
      });
    } catch (error) {
      tell(-received);
      reason = error;
      if (error.final && places.every((place) => place === places[0])) break;
    }
  }
  throw failureOf(reason, "connection", `pack ${hash.slice(0, 12)}: `);
}

async function fetchOnce(address, hash, tell) {
  const stalled = new AbortController();
  let timer = setTimeout(() => stalled.abort(), STALL_MS);
  const alive = () => {
    clearTimeout(timer);
    timer = setTimeout(() => stalled.abort(), STALL_MS);
  };
  try {
    const answer = await fetch(address, { signal: stalled.signal });
    if (!answer.ok) {
      const refused = new StageFailure("refused", `the server answered ${answer.status}`, { status: String(answer.status) });
      // This server refuses in JSON and means it; what somebody on the way says may be over soon.
      const own = /json/.test(answer.headers.get("content-type"));
      refused.final = own && answer.status >= 400 && answer.status < 500 && answer.status !== 408 && answer.status !== 429;
      throw refused;
    }
    const pieces = [];
    let length = 0;
    for (let reader = answer.body.getReader(); ; ) {
      const { done, value } = await reader.read();
      if (done) break;
      alive();
      pieces.push(value);
      length += value.length;
      tell(value.length);
    }
    const bytes = new Uint8Array(length);
    let at = 0;
    for (const piece of pieces) {
      bytes.set(piece, at);
      at += piece.length;
    }
    await check(hash, bytes);
    return bytes;
  } catch (error) {
    if (!stalled.signal.aborted) throw error;
    throw new StageFailure("stalled", `nothing arrived for ${STALL_MS / 1000} s`, { seconds: String(STALL_MS / 1000) });
  } finally {
    clearTimeout(timer);
  }
}

// Browsers offer SHA-256 only to secure contexts; elsewhere the pack's own header is the check.
async function check(hash, bytes) {
  if (!globalThis.crypto?.subtle) return;
  const digest = new Uint8Array(await crypto.subtle.digest("SHA-256", bytes));
  const found = Array.from(digest, (b) => b.toString(16).padStart(2, "0")).join("");
  if (found !== hash) throw new StageFailure("damaged", `arrived damaged (SHA-256 ${found.slice(0, 12)})`);
}

function pause(ms) {
  return new Promise((resolve) => setTimeout(resolve, ms));
}
