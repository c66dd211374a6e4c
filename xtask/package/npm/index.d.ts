// What static/stage/host.js exports. Times are in milliseconds, sizes in CSS pixels unless they say otherwise.

/** The graphics interface that draws. */
export type Backend = "webgpu" | "webgl2";

/** How a clip is drawn. */
export type Look = "stimulus" | "reference";

/** Which back end this browser runs. Rejects with an Error that says why neither does. */
export function backend(): Promise<Backend>;

/** The canvas module of a back end, loaded once; `fresh` loads it anew after it has crashed. */
export function loadModule(name: Backend, fresh?: boolean): Promise<CanvasModule>;

/** What wasm-bindgen makes of the crate `web/stage`. `openStage` calls it; pages need not. */
export interface CanvasModule {
  readonly Canvas: unknown;
}

/** A clip as a server describes it (`clips` of `/api/studies/STUDY`). */
export interface ClipSource {
  /** SHA-256 of the avatar pack; of a video, of its file. */
  avatar: string;
  /** SHA-256 of the operators pack; empty where nothing is solved. */
  operators: string;
  /** SHA-256 of the take pack; empty where nothing is solved. */
  take: string;
  /** The method and its parameters, as a study file names them. */
  method: { method: string; [parameter: string]: unknown };
  /** As played; 0 for a video, whose duration the browser knows alone. */
  duration_ms: number;
  /** Bytes to load if nothing is cached. */
  bytes: number;
  /** SHA-256 over avatar, capture, map, method, parameters and version of the solver. */
  provenance: string;
  /** SHA-256 of the weights as the server solved them; empty for a video. */
  weights_hash: string;
  /** Address of the folder of the packs; without it those that `fetchPack` asks. */
  packs?: string;
  /** Without it `stimulus`. */
  look?: Look;
  /** Media type of a video. */
  video?: string;
  /** What is heard with it. */
  sound?: ClipSound;
  /** Of an avatar at rest that trials of reverse correlation move: how it shows their units. */
  units?: { shapes: number; [field: string]: unknown };
  /** The face of one such trial. */
  face?: Record<string, unknown>;
}

/** What is heard with a clip. */
export interface ClipSound {
  /** SHA-256 of the file. */
  file: string;
  media_type: string;
  duration_s: number;
  /** Where in the file the first frame is. */
  from_s: number;
  /** How much of it is heard, where the file goes on. */
  length_s?: number;
  /** How much later than the face it is heard. */
  delay_ms: number;
  captions?: Record<string, unknown>[];
}

/** What is known of a clip that can be shown. */
export interface ClipSummary {
  clip: string;
  frames: number;
  rate_hz: number;
  duration_ms: number;
  /** SHA-256 of the weights as this browser solved them. */
  weights_hash: string;
  solve_ms: number;
  warnings: string[];
}

/** A clip that can be shown, with its weights. */
export interface PreparedClip extends Omit<ClipSummary, "clip"> {
  clip: string;
  /** Address of a video; null for a clip that is drawn. */
  video: string | null;
  /** frames x shapes, frame by frame; empty for a video. */
  weights: Float32Array;
  shapes: number;
  provenance: string;
  /** What the solver says of its work. */
  report: unknown;
}

/** A clip that was solved elsewhere. */
export interface SolvedClip {
  clip: string;
  /** A name of the avatar pack, by which a stage keeps it. */
  avatarHash: string;
  avatarPack: Uint8Array;
  /** frames x shapes, in the avatar's own order of shapes. */
  weights: Float32Array;
  frames: number;
  shapes: number;
  rate_hz: number;
  look?: Look;
  provenance?: string;
  weights_hash?: string;
}

/**
 * Fetches the packs of a clip and solves it in a worker; `onProgress` is told of 0 to 1. A clip that is known under
 * this name with the same provenance is not solved again.
 */
export function prepareClip(
  clipId: string,
  source: ClipSource,
  onProgress?: (part: number) => void,
): Promise<ClipSummary>;

/** A clip that is prepared; throws where it is not. */
export function preparedClip(clipId: string): PreparedClip;

/** Keeps a clip that was solved elsewhere; resolves when it can be shown. */
export function putClip(clip: SolvedClip): Promise<void>;

/**
 * The bytes of a pack by its SHA-256, fetched once and checked, from `/packs/HASH` or from the address that the page's
 * `<meta name="mimique-packs">` names. `onBytes` is told of every piece; a try that fails takes its pieces back with a
 * negative count. `folder` names the only address that is asked.
 */
export function fetchPack(hash: string, onBytes?: (count: number) => void, folder?: string): Promise<Uint8Array>;

/** The median interval between two frames of the display, measured once; `anew` measures it again. */
export function refreshPeriod(anew?: boolean): Promise<number>;

/** How a stage looks. */
export interface StageLook {
  /** `#rrggbb`; without it the default of the module. */
  background?: string;
  /** Without it 640. */
  width?: number;
  /** Without it 640. */
  height?: number;
  variant?: Look;
}

/** Opens a stage on a canvas. */
export function openStage(canvas: HTMLCanvasElement, look?: StageLook): Promise<Stage>;

/** Where one looks from: angles in radians, zoom 1 for the standard portrait. */
export interface View {
  yaw: number;
  pitch: number;
  zoom: number;
}

/** How a clip is played. */
export interface PlayOptions {
  /** Clips on other stages, in step with this one. */
  beside?: { stage: Stage; clipId: string }[];
  /** One after the other instead of in step. */
  inTurn?: boolean;
  /** With its sound. */
  heard?: boolean;
  /** Is told of every frame, in its callback. */
  told?: { frame(now: number, clipMs: number): void; end(now: number): void };
}

/** What was shown, frame by frame, in the display's clock. */
export interface PlayLog {
  backend: Backend;
  onset_ms: number | null;
  end_ms: number | null;
  refresh_hz: number;
  /** [shown at, time of the clip, 1 where the frame was late]. */
  frames: [number, number, 0 | 1][];
  late: number;
  longest_ms: number;
  drift_ms: number;
  width: number;
  height: number;
  device_pixel_ratio: number;
  weights_hash: string;
  provenance: string;
  beside_provenance: string;
  renderer: string;
  sound?: Record<string, unknown>;
  panel?: { clip: string; provenance: string; weights_hash: string }[];
  /** Why the play ended before its end. */
  aborted: string | null;
}

/** A canvas that draws clips. */
export interface Stage {
  /** Draws one frame; resolves when it is drawn. */
  show(clipId: string, timeMs: number): Promise<void>;
  /** Draws one frame at once; false while the adapter is busy, throws when the canvas is lost. */
  drawNow(clipId: string, timeMs: number): boolean;
  /** Plays a clip once; resolves with the log whatever happens. */
  play(clipId: string, options?: PlayOptions): Promise<PlayLog>;
  /** Aborts the play in progress; the log keeps why. */
  stop(why?: string): void;
  /** Gives everything back. */
  close(): void;
  /** Turns the camera. */
  setView(view: Partial<View>): void;
  /** Another backdrop or variant. */
  setLook(look: Pick<StageLook, "background" | "variant">): void;
  /** The clip-from-world matrix of the camera on a prepared clip: 16 numbers, column by column. */
  camera(clipId: string): ArrayLike<number>;
  state(): { backend: Backend | null; adapter: string; lost: string | null };
  /** Opens the canvas again and draws what it showed. */
  reopen(): Promise<void>;
  /** Loses the device on purpose: for tests. */
  lose(): void;
}
