// For pages without a build step: jsPsych's own script stands before it, @mimique/stage lies beside this package's folder,
// as npm and content delivery networks have it.
import "../stage/element.js";
import { pluginOf } from "./plugin.js";

if (!globalThis.jsPsychModule) {
  throw new Error("plugin-mimique: jsPsych is not there; put <script src=\".../jspsych/dist/index.browser.min.js\"> before this module");
}
const plugin = pluginOf(globalThis.jsPsychModule.ParameterType);
globalThis.jsPsychMimique = plugin;
export default plugin;
