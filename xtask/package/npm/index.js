// Canvas and solver of Mimique, as its pages use them; index.d.ts says what each of these does.
export * from "./modules/stage/host.js";
