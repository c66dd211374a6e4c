"""The peers of million_rows.rs: SciPy and NumPy on arrays in memory, polars on the file.

Reads the file that million_rows.rs wrote, then answers each line of standard input, the name of a
measurement, with one line of JSON. With `--once` it does what `mimique test kruskal-wallis` does, from
the file to the printed result, and ends.
"""

import json
import sys
import time

import numpy as np
import polars
import scipy
from scipy import stats

RUNS = 3
TYPES = {"method": polars.Categorical, "expression": polars.Categorical}


def read(path):
    return polars.read_csv(path, schema_overrides=TYPES)


path = sys.argv[1]
table = read(path)
methods, method = np.unique(table["method"].cast(polars.String).to_numpy(), return_inverse=True)
if "--once" in sys.argv:
    x = table["seconds"].to_numpy()
    print(stats.kruskal(*[x[method == code] for code in range(len(methods))]))
    sys.exit()
expressions, expression = np.unique(
    table["expression"].cast(polars.String).to_numpy(), return_inverse=True
)
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


runs = {"read": lambda: read(path)}
for kind, x, y in [("ratings", "rating", "other"), ("doubles", "seconds", "more")]:
    x, y = (table[name].to_numpy().astype(float) for name in (x, y))
    groups = [x[method == code] for code in range(len(methods))]
    differences = x - y
    runs[f"Kruskal-Wallis, {kind}"] = lambda groups=groups: stats.kruskal(*groups)
    runs[f"Wilcoxon, {kind}"] = lambda d=differences: stats.wilcoxon(d)
    runs[f"Spearman, {kind}"] = lambda x=x, y=y: stats.spearmanr(x, y)
    runs[f"Scheirer-Ray-Hare, {kind}"] = lambda x=x: scheirer_ray_hare(x)

versions = {"numpy": np.__version__, "scipy": scipy.__version__, "polars": polars.__version__}
print(json.dumps(versions), flush=True)
for line in sys.stdin:
    seconds = []
    for _ in range(RUNS):
        start = time.perf_counter()
        runs[line.strip()]()
        seconds.append(time.perf_counter() - start)
    print(json.dumps({"units": 1, "seconds": min(seconds)}), flush=True)
