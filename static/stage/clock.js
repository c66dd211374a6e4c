// The display's clock: requestAnimationFrame's timestamps, milliseconds.

let estimate = null;

/// Median interval between the display's frames, ms, over 24 of them; measured once while the page
/// is visible and does nothing else. `anew`: measured once more.
export function refreshPeriod(anew = false) {
  if (anew) estimate = null;
  estimate ??= measure(24).then((period) => {
    // A hidden page gets no frames: ask again the next time.
    if (period === null) estimate = null;
    return period ?? 1000 / 60;
  });
  return estimate;
}

function measure(count) {
  return new Promise((resolve) => {
    const intervals = [];
    let last = null;
    let waited = setTimeout(() => resolve(null), 4000);
    const tick = (now) => {
      if (last !== null) intervals.push(now - last);
      last = now;
      if (intervals.length < count) {
        requestAnimationFrame(tick);
        return;
      }
      clearTimeout(waited);
      intervals.sort((a, b) => a - b);
      resolve(intervals[count >> 1]);
    };
    requestAnimationFrame(tick);
  });
}
