"""The peers of `cargo xtask bench --layout`: scikit-learn and NumPy, one measurement a line of input.

    python layouts.py PROBLEM_FOLDER

The folder is written by crates/layout/benches/peers.rs. Each line of standard input is answered with
{"seconds": processor time, "answer": a number that both sides find}.
"""

import json
import sys
import time
import warnings
from pathlib import Path

import numpy as np
import sklearn
from sklearn.cluster import KMeans

warnings.filterwarnings("ignore")
folder = Path(sys.argv[1])
MARKERS, NOISE = 40, 1e-4


def read(name):
    return np.fromfile(folder / f"{name}.f64", dtype="<f8")


places, shapes, width = read("sizes").astype(int)
rows = read("rows").reshape(places, width)
starts = read("starts").reshape(-1, MARKERS, width)
deltas = read("deltas").reshape(places, 3, shapes)
prior = read("prior").reshape(shapes, shapes)
gram = read("gram").reshape(shapes, shapes)


def k_means():
    """The least inertia of ten starts, until the labels stay."""
    runs = (
        KMeans(MARKERS, init=start, n_init=1, algorithm="elkan", tol=0, max_iter=10_000).fit(rows)
        for start in starts
    )
    return min(run.inertia_ for run in runs)


def greedy():
    """Markers by the expected error: D S is kept and follows S by updates of rank 3."""
    known = prior.copy()
    seen = deltas @ known
    free = np.ones(places, dtype=bool)
    for _ in range(MARKERS):
        spread = seen @ deltas.transpose(0, 2, 1) + NOISE**2 * np.eye(3)
        told = (seen @ gram) @ seen.transpose(0, 2, 1)
        gains = np.trace(np.linalg.solve(spread, told), axis1=1, axis2=2)
        best = int(np.argmax(np.where(free, gains, -np.inf)))
        free[best] = False
        own = seen[best]
        gain = np.linalg.solve(spread[best], own)
        known -= own.T @ gain
        seen -= (deltas @ own.T) @ gain
    return 1e3 * np.sqrt(np.sum(gram * known))


MEASURED = {"k-means": k_means, "greedy": greedy}
greeting = {"ready": True, "sklearn": sklearn.__version__, "numpy": np.__version__}
print(json.dumps(greeting), flush=True)
for line in sys.stdin:
    work = MEASURED[line.strip()]
    start = time.process_time()
    answer = work()
    print(json.dumps({"seconds": time.process_time() - start, "answer": float(answer)}), flush=True)
