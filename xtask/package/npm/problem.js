// What is wrong with what an element was given: where it stands, the value, what helps.

/** An Error with a `code` for programs; of what the canvas and the solver refuse the code is theirs. */
export class StageProblem extends Error {
  constructor(code, message, cause) {
    super(message, { cause });
    this.name = "StageProblem";
    this.code = code;
  }

  /** Of an attribute (or the property of the same name): its value, what is wrong with it, what helps. */
  static ofAttribute(name, value, wrong, remedy) {
    return new StageProblem("attribute", `mimique-stage: ${name}="${value}": ${wrong}; ${remedy}`);
  }

  /** Any error, with the element's name before it. */
  static of(error) {
    if (error instanceof StageProblem) return error;
    return new StageProblem(error?.code ?? "failed", `mimique-stage: ${error?.message ?? error}`, error);
  }
}
