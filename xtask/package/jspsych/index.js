// For bundlers: `import Mimique from "@mimique/jspsych-plugin"`.
import { ParameterType } from "jspsych";
import "@mimique/stage/element.js";
import { pluginOf } from "./plugin.js";

export default pluginOf(ParameterType);
