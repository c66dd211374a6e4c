// Why something could not be shown, for the page to word: a code of the texts `failed_*`
// (`crates/study/src/text/table.rs`), the values that they name, and a sentence for those who look for the
// cause.

export class StageFailure extends Error {
  /// `values`: what stands for the words in braces.
  constructor(code, message, values = {}) {
    super(message);
    this.code = code;
    this.values = values;
  }
}

/// The same failure of another part: its message with `prefix` before it, its code if it has one.
export function failureOf(error, code, prefix = "") {
  const message = `${prefix}${error?.message ?? error}`;
  return new StageFailure(error?.values ? error.code : code, message, error?.values ?? {});
}
