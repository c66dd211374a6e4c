// What is called by a name in the page's language, since it comes from no file.
import { say } from "./texts.js";

/// The name of an avatar, by its facts.
export const avatarName = ({ builtIn, file }) => (builtIn ? say("built-in.head-name") : file);

/// The name of a take, by its facts.
export const takeName = ({ builtIn, file }) => (builtIn ? say("built-in.actor-name") : file);
