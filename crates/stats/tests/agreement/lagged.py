"""What NumPy and SciPy give for lagged correlations with gaps: a line per lag with r and its 95 % interval over people.

Courses come as JSON: rate, lags, the least number of instants, clips, and plays with their tracks; a gap is null.
"""

import json
import sys

import numpy as np
from scipy import stats

given = json.load(open(sys.argv[1]))
courses = lambda lists: np.array(lists, dtype=float)
clips = [courses(clip) for clip in given["clips"]]


def play(clip, track, lag):
    """Mean of Fisher's z over the shapes; none where none has enough instants."""
    found = []
    for x, y in zip(clip, track):
        x, y = (x[: len(x) - lag], y[lag:]) if lag >= 0 else (x[-lag:], y[:lag])
        both = np.isfinite(x) & np.isfinite(y)
        if both.sum() >= given["least"]:
            found.append(np.arctanh(stats.pearsonr(x[both], y[both]).statistic))
    return np.mean(found) if found else np.nan


for lag in range(given["first"], given["last"] + 1):
    people = {}
    for one in given["plays"]:
        people.setdefault(one["person"], []).append(play(clips[one["clip"]], courses(one["track"]), lag))
    z = np.array([np.nanmean(own) for own in people.values()])
    low, high = stats.t.interval(0.95, len(z) - 1, loc=z.mean(), scale=stats.sem(z))
    print(*[repr(float(np.tanh(value))) for value in (z.mean(), low, high)])
