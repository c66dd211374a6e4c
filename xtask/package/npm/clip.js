// From what an element is given to a clip that can be shown. A clip is given in one of three ways:
//   {src, clip, packs}     the address of a JSON that describes it, and the folder of its packs
//   {source, clip, packs}  the same description as an object
//   {avatar, capture, …}   files, solved here by the studio's module (from-files.js, loaded only then)
import { prepareClip } from "./modules/stage/host.js";
import { StageProblem } from "./problem.js";

// What a pack fails with that does not arrive.
const FETCHING = ["connection", "damaged", "refused", "stalled"];

// Descriptions by their address: a study's clips are asked for once.
const described = new Map();

/** Prepares a clip; resolves with {id, name, summary}: `id` is its name on a stage. */
export async function prepared(given, onProgress = () => {}) {
  const ways = ["src", "source", "avatar"].filter((way) => given[way]);
  if (ways.length !== 1) {
    const found = ways.length === 0 ? "no clip is given" : `a clip is given in ${ways.length} ways (${ways.join(", ")})`;
    throw new StageProblem("attribute", `mimique-stage: ${found}; give src, or the property source, or avatar and capture`);
  }
  if (ways[0] === "avatar") {
    const { solvedFromFiles } = await import("./from-files.js");
    return solvedFromFiles(given, onProgress);
  }
  const [source, name, folder] = ways[0] === "src" ? await at(given) : [given.source, given.clip || "clip", ""];
  checked(source, name);
  const packs = given.packs ? absolute("packs", given.packs).replace(/\/$/, "") : source.packs || folder;
  // Clips of one name may come from several studies.
  const id = `${name}@${source.provenance.slice(0, 16)}`;
  const summary = await prepareClip(id, packs ? { ...source, packs } : source, onProgress).catch((error) => {
    if (!FETCHING.includes(error.code)) throw error;
    throw new StageProblem(error.code, `mimique-stage: clip ${name}: ${error.message}; asked was ${packs || "/packs"}: let packs name the folder that has them`, error);
  });
  return { id, name, summary: { ...summary, clip: name } };
}

// The description that an address leads to, its name, and the folder of its packs: that of `mimique export-site` beside the
// file; a server has it at its root.
async function at({ src, clip }) {
  const address = absolute("src", src);
  if (!described.has(address)) {
    const found = fetchJson("src", address);
    described.set(address, found);
    found.catch(() => described.delete(address));
  }
  const whole = await described.get(address);
  const clips = whole.clips ?? whole.bundle?.clips;
  const folder = new URL(/\/api\/studies\/[^/]+$/.test(new URL(address).pathname) ? "/packs" : "packs", address).href;
  if (!clips) return [whole, clip || "clip", folder];
  const names = Object.keys(clips);
  if (!clip && names.length > 1) {
    throw StageProblem.ofAttribute("src", src, `${names.length} clips are described there, and attribute clip is empty`, `name one of: ${few(names)}`);
  }
  const name = clip || names[0];
  if (!Object.hasOwn(clips, name)) throw StageProblem.ofAttribute("clip", name, "no such clip is described there", `there are: ${few(names)}`);
  return [clips[name], name, folder];
}

function checked(source, name) {
  const of = name === "clip" ? "the clip" : `clip ${name}`;
  const wrong = (why) => new StageProblem("description", `mimique-stage: the description of ${of}: ${why}; take it as mimique describes it (clips of site.json, or of /api/studies/STUDY)`);
  if (source === null || typeof source !== "object") throw wrong(`${JSON.stringify(source)} is no object`);
  for (const key of ["avatar", "operators", "take", "provenance"]) {
    if (typeof source[key] !== "string") throw wrong(`${key} is ${JSON.stringify(source[key]) ?? "missing"} instead of a text`);
  }
  if (!/^[0-9a-f]{64}$/.test(source.avatar)) throw wrong(`avatar is "${source.avatar}" instead of the SHA-256 of a pack`);
  if (typeof source.duration_ms !== "number") throw wrong(`duration_ms is ${JSON.stringify(source.duration_ms) ?? "missing"} instead of a number`);
}

/** An address as the page means it. */
export function absolute(attribute, value) {
  try {
    return new URL(value, document.baseURI).href;
  } catch {
    throw StageProblem.ofAttribute(attribute, value, "no address", "write an address, relative to the page or whole");
  }
}

/** What an address answers, or an error that names it. */
export async function fetched(attribute, address) {
  const answer = await fetch(address).catch((error) => {
    const remedy = "see that the host runs, and that it lets other pages read (Access-Control-Allow-Origin) where it is not the page's own";
    throw StageProblem.ofAttribute(attribute, address, `not reached (${error.message})`, remedy);
  });
  if (!answer.ok) throw StageProblem.ofAttribute(attribute, address, `the host answered ${answer.status}`, "give the address of a file that is there");
  return answer;
}

async function fetchJson(attribute, address) {
  const answer = await fetched(attribute, address);
  return answer.json().catch((error) => {
    throw StageProblem.ofAttribute(attribute, address, `no JSON (${error.message})`, "give the address of a clip's description, or of a site.json");
  });
}

function few(names) {
  return names.length > 12 ? `${names.slice(0, 12).join(", ")} and ${names.length - 12} more` : names.join(", ");
}
