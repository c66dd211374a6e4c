// Work of which only the newest wish counts: while one runs, further calls ask for one more, whatever their number.

/// A function that does `work`, and does it again until nothing was asked for meanwhile; it resolves when nothing is left,
/// at once where another call is at it.
export function newest(work) {
  let isStale = false;
  let isBusy = false;
  return async () => {
    isStale = true;
    if (isBusy) return;
    isBusy = true;
    try {
      while (isStale) {
        isStale = false;
        await work();
      }
    } finally {
      isBusy = false;
    }
  };
}
