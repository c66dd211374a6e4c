"""The peers of million_rows.rs: SciPy and NumPy on arrays in memory, polars on the file."""

import sys
import time

import numpy as np
from scipy import stats

RUNS = 7


def best(name, run):
    seconds = []
    for _ in range(RUNS):
        start = time.perf_counter()
        run()
        seconds.append(time.perf_counter() - start)
    print(f"{name}\t{min(seconds)}", flush=True)


path = sys.argv[1]
try:
    import polars

    types = {"method": polars.Categorical, "expression": polars.Categorical}
    best("read CSV", lambda: polars.read_csv(path, schema_overrides=types))
except ImportError:
    print("polars is not installed", file=sys.stderr)

words = np.genfromtxt(path, delimiter=",", skip_header=1, usecols=(0, 1), dtype="U8")
data = np.loadtxt(path, delimiter=",", skiprows=1, usecols=(2, 3, 4, 5))
methods, method = np.unique(words[:, 0], return_inverse=True)
expressions, expression = np.unique(words[:, 1], return_inverse=True)
cell = method * len(expressions) + expression


def scheirer_ray_hare(y):
    """Type I from ranks and cell sums; balanced enough that the two main effects need no more."""
    ranks = stats.rankdata(y)
    n = len(y)
    ms_total = ((ranks - ranks.mean()) ** 2).sum() / (n - 1)

    def between(codes):
        counts, sums = np.bincount(codes), np.bincount(codes, weights=ranks)
        return (sums**2 / counts).sum() - n * (n + 1) ** 2 / 4

    a, b, both = between(method), between(expression), between(cell)
    h = np.array([a, b, both - a - b]) / ms_total
    df = [len(methods) - 1, len(expressions) - 1, (len(methods) - 1) * (len(expressions) - 1)]
    return h, stats.chi2.sf(h, df)


for kind, x, y in [("ratings", data[:, 0], data[:, 1]), ("doubles", data[:, 2], data[:, 3])]:
    x, y = x.copy(), y.copy()
    groups = [x[method == code] for code in range(len(methods))]
    differences = x - y
    best(f"Kruskal-Wallis, {kind}", lambda: stats.kruskal(*groups))
    best(f"Wilcoxon, {kind}", lambda: stats.wilcoxon(differences))
    best(f"Spearman, {kind}", lambda: stats.spearmanr(x, y))
    best(f"Scheirer-Ray-Hare, {kind}", lambda: scheirer_ray_hare(x))
