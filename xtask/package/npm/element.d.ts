// The element <mimique-stage>. Times are in milliseconds, angles in radians.
import type { ClipSource, ClipSummary, PlayLog, View } from "./index.js";

/** A clip that a server or `mimique export-site` describes. */
export interface DescribedClip {
  /** Address of a JSON: one clip's description, `site.json`, or `/api/studies/STUDY` of a server. */
  src?: string;
  /** The description itself, in the place of `src`. */
  source?: ClipSource | null;
  /** Which clip of several. */
  clip?: string;
  /** Address of the folder of the packs; without it `packs` beside `src`, of a server `/packs`. */
  packs?: string;
}

/** A clip that is solved here from files. A text is an address. */
export interface ClipOfFiles {
  /** GLB, glTF with its data inside, an archive of OBJ poses; or `built-in`. */
  avatar: string | Blob;
  /** The avatar's NAME.avatar.json. */
  settings?: string | Blob;
  /** A capture, or recorded weights; or `built-in`. */
  capture: string | Blob;
  /** `mm`, `cm` or `m`, of a capture that does not say it. */
  unit?: string;
  /** Frames per second, of a capture that does not say it. */
  rate?: string | number;
  /** A marker map; without it one is suggested. */
  map?: string | Blob;
  /** A method's name, or its settings as an object or JSON; without it `lsts`. */
  method?: string | { method: string; [parameter: string]: unknown };
  /** The part that is shown, `FIRST:END`; the whole capture is solved. */
  frames?: string;
}

export type GivenClip = DescribedClip | ClipOfFiles;

/** The log of a play of one or more elements. */
export interface StageLog extends PlayLog {
  /** The clips' names, in the order of the elements. */
  clips: string[];
}

/** How an element plays. */
export interface StagePlayOptions {
  /** Other elements whose clips play along. */
  beside?: MimiqueStage[];
  /** One after the other instead of in step. */
  inTurn?: boolean;
  /** With its sound: a click or a key of the person must have come before. */
  heard?: boolean;
  /** Is told of every frame in its callback. */
  told?: { frame?(now: number, clipMs: number): void; end?(now: number): void };
}

/** What is wrong: place, value and remedy in its message. */
export declare class StageProblem extends Error {
  /** `attribute`, `description`, `method`, `time`, `playing`, `detached`; or a code of canvas, solver or network. */
  readonly code: string;
}

export interface StageEvents {
  /** 0 to 1. */
  "stage-progress": CustomEvent<{ part: number }>;
  "stage-ready": CustomEvent<ClipSummary>;
  /** The first frame, in the clock of `performance.now()` and of `event.timeStamp`. */
  "stage-onset": CustomEvent<{ onset_ms: number }>;
  "stage-played": CustomEvent<StageLog>;
  "stage-error": CustomEvent<StageProblem>;
}

export declare class MimiqueStage extends HTMLElement {
  /** Prepares a clip ahead, so that an element that is given the same shows it at once. */
  static prepare(given: GivenClip, onProgress?: (part: number) => void): Promise<ClipSummary>;

  src: string | null;
  source: ClipSource | null;
  clip: string | null;
  packs: string | null;
  avatar: string | Blob | null;
  settings: string | Blob | null;
  capture: string | Blob | null;
  unit: string | null;
  rate: string | number | null;
  map: string | Blob | null;
  method: string | { method: string; [parameter: string]: unknown } | null;
  frames: string | null;
  /** `#rrggbb`; without it the default of the canvas. */
  background: string | null;
  /** What screen readers call the picture. */
  label: string | null;

  readonly state: "empty" | "loading" | "ready" | "playing" | "failed";
  readonly summary: ClipSummary | null;
  readonly duration: number;
  readonly time: number;
  /** Resolves once the clip's first frame stands; rejects with a StageProblem. */
  readonly ready: Promise<ClipSummary>;

  /** Plays once from the first frame; resolves with the log whatever happens, once the clip is there. */
  play(options?: StagePlayOptions): Promise<StageLog>;
  /** Ends the play; the log keeps why, the picture stays. */
  stop(why?: string): void;
  /** `stop("paused")`. */
  pause(): void;
  /** Shows the frame at a time of the clip. */
  seek(ms: number): Promise<void>;
  /** Turns the camera. */
  view(view: Partial<View>): void;

  addEventListener<K extends keyof StageEvents>(
    type: K,
    listener: (this: MimiqueStage, event: StageEvents[K]) => unknown,
    options?: boolean | AddEventListenerOptions,
  ): void;
  addEventListener(type: string, listener: EventListenerOrEventListenerObject, options?: boolean | AddEventListenerOptions): void;
}

declare global {
  interface HTMLElementTagNameMap {
    "mimique-stage": MimiqueStage;
  }
}
