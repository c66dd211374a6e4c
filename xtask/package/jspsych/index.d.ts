import type { JsPsych, JsPsychPlugin, PluginInfo, TrialType } from "jspsych";
import type { ClipOfFiles, DescribedClip } from "@mimique/stage/element.js";
import type { ClipSummary, View } from "@mimique/stage";

/** A clip of a trial: as the element takes it, files by their addresses. */
export type TrialClip = DescribedClip | (ClipOfFiles & { avatar: string; capture: string; map?: string; settings?: string });

/** A trial's parameters, beside those that every trial has. */
export interface MimiqueParameters {
  clips: TrialClip[];
  in_turn?: boolean;
  clip_labels?: string[];
  columns?: number | null;
  clip_size?: number;
  background?: string;
  view?: Partial<View> | null;
  sound?: boolean;
  prompt?: string | null;
  choices?: string[];
  keys?: string[];
  button_html?: (choice: string, choice_index: number) => string;
  response_allowed_while_playing?: boolean;
  response_ends_trial?: boolean;
  trial_ends_after_clips?: boolean;
  trial_duration?: number | null;
  save_frames?: boolean;
  again_label?: string;
}

/** A trial's data, beside what jsPsych adds. */
export interface MimiqueData {
  rt: number | null;
  response: number | null;
  response_source: "button" | "key" | null;
  response_key: string | null;
  clips: string[];
  provenance: string[];
  weights_hash: string[];
  onset_ms: number | null;
  end_ms: number | null;
  frames: [number, number, 0 | 1][] | null;
  late: number | null;
  longest_ms: number | null;
  drift_ms: number | null;
  refresh_hz: number | null;
  backend: "webgpu" | "webgl2" | null;
  renderer: string | null;
  aborted: string | null;
  interrupted: string[];
  failure: { code: string; message: string } | null;
}

declare class MimiquePlugin implements JsPsychPlugin<PluginInfo> {
  static info: PluginInfo;
  /** Prepares clips ahead, so that their trials show them at once. */
  static preload(clips: TrialClip[]): Promise<ClipSummary[]>;
  constructor(jsPsych: JsPsych);
  trial(display_element: HTMLElement, trial: TrialType<PluginInfo>, on_load?: () => void): Promise<MimiqueData>;
  simulate(
    trial: TrialType<PluginInfo>,
    simulation_mode: string,
    simulation_options: unknown,
    load_callback: () => void,
  ): void | Promise<MimiqueData>;
}

export default MimiquePlugin;
