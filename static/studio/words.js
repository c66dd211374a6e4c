// Every text of the studio by its key: English, French. A word in braces is filled in. The parts of the table:
// words-window.js (the window's frame, faces, time, exports), words-work.js (what is done to files and takes) and
// words-labels.js (labels and exertion).
import { LABELS } from "./words-labels.js";
import { WINDOW } from "./words-window.js";
import { WORK } from "./words-work.js";

export const WORDS = { ...WINDOW, ...WORK, ...LABELS };
