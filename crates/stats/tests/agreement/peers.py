"""What SciPy gives for random data sets; in and out as in peers.R."""

import sys
import warnings

import numpy as np
from scipy import stats

warnings.simplefilter("ignore")


def run(name, x, y):
    if name == "kruskal":
        return stats.kruskal(*[x[y == code] for code in np.unique(y)])
    if name == "wilcoxon":
        # As R: zeros dropped, exact below 50 without ties and zeros, else corrected for continuity.
        used = x[x != 0]
        exact = len(used) == len(x) < 50 and len(np.unique(np.abs(used))) == len(used)
        p = stats.wilcoxon(used, correction=not exact, method="exact" if exact else "asymptotic").pvalue
        return stats.rankdata(np.abs(used))[used > 0].sum(), p
    if name == "mannwhitney":
        a, b = x[y == 0], x[y == 1]
        exact = len(a) < 50 and len(b) < 50 and len(np.unique(x)) == len(x)
        return stats.mannwhitneyu(a, b, method="exact" if exact else "asymptotic")
    if name == "spearman":
        return stats.spearmanr(x, y)
    if name == "chisquare":
        counts = stats.contingency.crosstab(x, y).count
        return stats.chi2_contingency(counts)[:2]
    if name == "friedman":
        return stats.friedmanchisquare(*x.reshape(-1, 3).T)
    return ()


for line in open(sys.argv[1]):
    name, *columns = line.rstrip("\n").split("\t")
    x, *rest = [np.array([float(cell) for cell in column.split()]) for column in columns]
    print(*[repr(float(value)) for value in run(name, x, rest[0] if rest else None)])
