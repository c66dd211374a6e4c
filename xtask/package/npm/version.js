/** The package's version: what a log names as its renderer. */
export const VERSION = "0.1.0";
