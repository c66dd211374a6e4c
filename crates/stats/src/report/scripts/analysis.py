"""The numbers of this report once more, by NumPy and SciPy.

    python analysis.py    computes and compares with data/numbers.csv

In: data/trials.csv (the trials in the analysis, after all exclusions) and data/numbers.csv (what
Mimique computed). Out: data/numbers-python.csv. Exit status 1 if a number differs by more than 1e-8
of its size.
"""

import csv
import itertools
import math
import os
import sys

import numpy as np
from scipy import stats

os.chdir(os.path.dirname(os.path.abspath(__file__)))
with open("data/trials.csv", encoding="utf-8", newline="") as file:
    reader = csv.reader(file)
    names = next(reader)
    columns = {name: np.array(column, dtype=object) for name, column in zip(names, zip(*reader))}
person = columns["participant_id"]
numeric = {}


def number(name):
    """A column as numbers; words become their places in order."""
    if name not in numeric:
        column = columns[name]

        def value(cell):
            try:
                return float(cell)
            except ValueError:
                return math.nan

        values = np.array([value(cell) for cell in column])
        given = column != ""
        if np.isnan(values[given]).all():
            order = {word: place + 1 for place, word in enumerate(sorted(set(column[given])))}
            values = np.array([order.get(cell, math.nan) for cell in column])
        numeric[name] = values
    return numeric[name]


def is_in(name, levels):
    return np.isin(columns[name].astype(str), levels)


def means_by(keys, labels, values, levels):
    """Mean of each key (rows) at each level (columns); only keys that have all of them."""
    sums = {}
    for key, label, value in zip(keys, labels, values):
        cell = sums.setdefault(key, {}).setdefault(label, [0.0, 0])
        cell[0] += value
        cell[1] += 1
    whole = sorted(key for key, cells in sums.items() if all(level in cells for level in levels))
    rows = [[sums[key][level][0] / sums[key][level][1] for level in levels] for key in whole]
    return whole, np.array(rows)


def person_means(y, g, levels):
    v = number(y)
    keep = ~np.isnan(v) & is_in(g, levels)
    return means_by(person[keep], columns[g][keep], v[keep], levels)


def overall_means(y):
    v = number(y)
    keep = ~np.isnan(v)
    people, rows = means_by(person[keep], np.full(keep.sum(), "all"), v[keep], ["all"])
    return people, rows[:, 0]


def about(name, people):
    first = {}
    for key, cell in zip(person, columns[name]):
        first.setdefault(key, cell)
    return np.array([first[key] for key in people], dtype=object)


def signed_ranks(d):
    """Pratt's zeros: exact and conditional on the ranks up to 200 differences other than zero."""
    d = np.round(d, 9)
    r = stats.rankdata(np.abs(d))
    tossed = r[d != 0]
    plus = r[d > 0].sum()
    if len(tossed) <= 200:
        distribution = np.ones(1)
        for k in np.round(2 * tossed).astype(int):
            zeros = np.zeros(k)
            distribution = (np.append(distribution, zeros) + np.append(zeros, distribution)) / 2
        w = int(round(2 * plus))
        p = min(1.0, 2 * min(distribution[: w + 1].sum(), distribution[w:].sum()))
    else:
        z = (plus - tossed.sum() / 2) / math.sqrt((tossed**2).sum() / 4)
        p = 2 * stats.norm.sf(abs(z))
    return dict(statistic=plus, p=p, effect=rank_biserial(d), n=len(d), **hodges_lehmann(d))


def rank_biserial(d):
    d = d[d != 0]
    r = stats.rankdata(np.abs(d))
    return (r[d > 0].sum() - r[d < 0].sum()) / r.sum()


def hodges_lehmann(d):
    """Median and 95 % interval of the Walsh averages."""
    n = len(d)
    walsh = np.sort((np.add.outer(d, d) / 2)[np.tril_indices(n)])
    if n <= 200:
        counts = np.ones(1)
        for k in range(1, n + 1):
            counts = (np.append(counts, np.zeros(k)) + np.append(np.zeros(k), counts)) / 2
        cut = max(int((np.cumsum(counts) <= 0.025).sum()) - 1, 0)
    else:
        variance = n * (n + 1) * (2 * n + 1) / 24
        cut = max(math.floor(len(walsh) / 2 - stats.norm.isf(0.025) * math.sqrt(variance) - 0.5), 0)
    cut = min(cut, (len(walsh) - 1) // 2)
    return dict(estimate=np.median(walsh), low=walsh[cut], high=walsh[len(walsh) - 1 - cut])


def groups(values, labels, levels):
    split = [values[(labels == level) & ~np.isnan(values)] for level in levels]
    return [group for group in split if len(group)]


def many_groups(samples):
    h, p = stats.kruskal(*samples)
    n = sum(map(len, samples))
    return dict(statistic=h, p=p, effect=h / (n - 1), n=n)


def two_groups(samples):
    x, y = samples
    ties = len(set(x) | set(y)) < len(x) + len(y)
    exact = len(x) < 50 and len(y) < 50 and not ties
    u, p = stats.mannwhitneyu(x, y, method="exact" if exact else "asymptotic")
    return dict(statistic=u, p=p, effect=2 * u / (len(x) * len(y)) - 1, n=len(x) + len(y))


def by_unit(y, g, levels, unit):
    if unit == "trials":
        return groups(number(y), columns[g], levels)
    people, means = overall_means(y)
    return groups(means, about(g, people), levels)


def kruskal_wallis(y, g, levels, unit):
    return many_groups(by_unit(y, g, levels, unit))


def mann_whitney(y, g, levels, unit):
    return two_groups(by_unit(y, g, levels, unit))


def adjusted(p):
    """Holm's correction."""
    corrected = np.empty(len(p))
    running = 0.0
    for place, i in enumerate(np.argsort(p, kind="stable")):
        running = max(running, (len(p) - place) * p[i])
        corrected[i] = min(1.0, running)
    return corrected


def differences_by_trait(y, g, levels, a, b, trait, trait_levels):
    people, m = person_means(y, g, levels)

    def of_pair(i, j):
        samples = groups(np.round(m[:, i] - m[:, j], 9), about(trait, people), trait_levels)
        return two_groups(samples) if len(samples) == 2 else many_groups(samples)

    pairs = list(itertools.combinations(range(len(levels)), 2))
    p = adjusted([of_pair(*pair)["p"] for pair in pairs])
    return dict(**of_pair(a - 1, b - 1), p_holm=p[pairs.index((a - 1, b - 1))])


def chi_square(y, g, levels):
    samples = groups(number(y), columns[g], levels)
    answers = sorted(set(np.concatenate(samples)))
    counts = np.array([[(sample == answer).sum() for answer in answers] for sample in samples])
    chosen = stats.chi2_contingency(counts)
    plain = stats.chi2_contingency(counts, correction=False)[0]
    n = counts.sum()
    effect = math.sqrt(plain / (n * (min(counts.shape) - 1)))
    return dict(statistic=chosen[0], p=chosen[1], effect=effect, n=n)


def spearman_p(x, y, rho):
    """As R: over all orders up to 9 pairs, Edgeworth series (AS 89) to 1290, both without ties."""
    n = len(x)
    ties = len(set(x)) < n or len(set(y)) < n
    if ties or n > 1290:
        return stats.spearmanr(x, y).pvalue
    s = round(n * (n * n - 1) * (1 - rho) / 6)
    upper = s > n * (n * n - 1) / 6
    if n <= 9:
        sums = [
            sum((i - j) ** 2 for i, j in enumerate(order)) for order in itertools.permutations(range(n))
        ]
        tail = np.mean(np.array(sums) >= s) if upper else np.mean(np.array(sums) <= s)
        return min(1.0, 2 * tail)
    b = 1 / n
    q = s if upper else s + 2
    z = (6 * (q - 1) * b / (n * n - 1) - 1) * math.sqrt(n - 1)
    w = z * z
    inner = 0.0879 + 0.0151 * b - w * (0.0072 - 0.0831 * b + w * b * (0.0131 - 0.00046 * w))
    series = z * b * (
        0.2274 + b * (0.2531 + 0.1745 * b) + w * (-0.0758 + b * (0.1033 + 0.3932 * b) - w * b * inner)
    )
    correction = series / math.exp(w / 2)
    tail = correction + stats.norm.sf(z) if upper else stats.norm.cdf(z) - correction
    return min(1.0, 2 * min(max(tail, 0.0), 1.0))


def rho_of(x, y):
    keep = ~np.isnan(x) & ~np.isnan(y)
    x, y = x[keep], y[keep]
    rho = stats.spearmanr(x, y).statistic
    return dict(statistic=rho, p=spearman_p(x, y, rho), effect=rho, n=len(x))


def spearman(x, y, unit):
    if unit == "trials":
        return rho_of(number(x), number(y))
    people, means = overall_means(y)
    first = {}
    for key, value in zip(person, number(x)):
        first.setdefault(key, value)
    return rho_of(np.array([first[key] for key in people]), means)


def wilcoxon_rho(x, y):
    a, b = number(x), number(y)
    keep = ~np.isnan(a) & ~np.isnan(b)
    rho = []
    for one in sorted(set(person[keep])):
        own = keep & (person == one)
        if len(set(a[own])) > 1 and len(set(b[own])) > 1:
            ranks = stats.rankdata(a[own]), stats.rankdata(b[own])
            rho.append(np.corrcoef(*ranks)[0, 1])
    result = signed_ranks(np.array(rho))
    return dict(statistic=result["statistic"], p=result["p"], effect=result["estimate"], n=result["n"])


def wilcoxon_trials(y, g, levels, matched):
    v = number(y)
    keep = ~np.isnan(v) & is_in(g, levels)
    keys = list(zip(person[keep], *(columns[name][keep] for name in matched)))
    _, m = means_by(keys, columns[g][keep], v[keep], levels)
    d = np.round(m[:, 0] - m[:, 1], 9)
    used = d[d != 0]
    exact = len(used) < 50 and len(used) == len(d) and len(set(np.abs(used))) == len(used)
    p = stats.wilcoxon(used, correction=not exact, method="exact" if exact else "asymptotic").pvalue
    plus = stats.rankdata(np.abs(used))[used > 0].sum()
    return dict(statistic=plus, p=p, effect=rank_biserial(d), n=len(d))


def wilcoxon_people(y, g, levels, a, b):
    _, m = person_means(y, g, levels)
    return signed_ranks(m[:, a - 1] - m[:, b - 1])


def friedman(y, g, levels):
    _, m = person_means(y, g, levels)
    n, k = m.shape
    chi_square = stats.friedmanchisquare(*m.T)[0]
    f = (n - 1) * chi_square / (n * (k - 1) - chi_square)
    p = stats.f.sf(f, k - 1, (k - 1) * (n - 1))
    return dict(statistic=f, p=p, effect=chi_square / (n * (k - 1)), n=n)


def dummies(labels, levels):
    return np.array([[float(label == level) for level in levels[1:]] for label in labels])


def residual_squares(design, values):
    fitted = design @ np.linalg.lstsq(design, values, rcond=None)[0]
    return ((values - fitted) ** 2).sum()


def crossed(a, b):
    return (a[:, :, None] * b[:, None, :]).reshape(len(a), -1)


def scheirer_ray_hare(y, a, a_levels, b, b_levels, effect, unit):
    """An analysis of variance of ranks (type I), read as chi-square."""
    v, of_a, of_b = number(y), columns[a], columns[b]
    if unit != "trials":
        people, v = overall_means(y)
        of_a, of_b = about(a, people), about(b, people)
    keep = ~np.isnan(v) & np.isin(of_a, a_levels) & np.isin(of_b, b_levels)
    r = stats.rankdata(v[keep])
    of_a, of_b = dummies(of_a[keep], a_levels), dummies(of_b[keep], b_levels)
    parts = [np.ones((len(r), 1)), of_a, of_b, crossed(of_a, of_b)]
    before = residual_squares(np.hstack(parts[:effect]), r)
    after = residual_squares(np.hstack(parts[: effect + 1]), r)
    rank = lambda many: np.linalg.matrix_rank(np.hstack(many))
    df = rank(parts[: effect + 1]) - rank(parts[:effect])
    h = (before - after) / r.var(ddof=1)
    return dict(statistic=h, p=stats.chi2.sf(h, df), effect=h / (len(r) - 1), n=len(r))


def aligned_rank_transform(y, a, a_levels, b, b_levels, effect):
    """Wobbrock's transform of the means of each person and combination."""
    v = number(y)
    keep = ~np.isnan(v) & is_in(a, a_levels) & is_in(b, b_levels)
    cells = np.empty(keep.sum(), dtype=object)
    cells[:] = list(zip(columns[a][keep], columns[b][keep]))
    pairs = sorted(set(cells))
    people, m = means_by(person[keep], cells, v[keep], pairs)
    a_of = [a_levels.index(pair[0]) for pair in pairs]
    b_of = [b_levels.index(pair[1]) for pair in pairs]
    n, sizes = len(people), (len(a_levels), len(b_levels))
    cube = np.empty((n, *sizes))
    cube[:, a_of, b_of] = m

    def estimates(cube):
        grand = cube.mean()
        of_a = cube.mean(axis=(0, 2), keepdims=True) - grand
        of_b = cube.mean(axis=(0, 1), keepdims=True) - grand
        both = cube.mean(axis=0, keepdims=True) - grand - of_a - of_b
        return [estimate + np.zeros_like(cube) for estimate in (of_a, of_b, both)]

    aligned = np.round(cube - cube.mean(axis=0, keepdims=True) + estimates(cube)[effect - 1], 8)
    r = stats.rankdata(aligned).reshape(cube.shape)
    squares = (estimates(r)[effect - 1] ** 2).sum()
    between_people = ((r.mean(axis=(1, 2)) - r.mean()) ** 2).sum() * sizes[0] * sizes[1]
    between_cells = ((r.mean(axis=0) - r.mean()) ** 2).sum() * n
    residual = ((r - r.mean()) ** 2).sum() - between_people - between_cells
    df1 = [sizes[0] - 1, sizes[1] - 1, (sizes[0] - 1) * (sizes[1] - 1)][effect - 1]
    df2 = (sizes[0] * sizes[1] - 1) * (n - 1)
    f = squares / df1 / (residual / df2)
    return dict(statistic=f, p=stats.f.sf(f, df1, df2), effect=f * df1 / (f * df1 + df2), n=n)


def describe(y, g, level):
    v = number(y)
    v = v[~np.isnan(v) & is_in(g, [level])]
    q1, q3 = np.quantile(v, [0.25, 0.75])
    return dict(n=len(v), mean=v.mean(), sd=v.std(ddof=1), median=np.median(v), q1=q1, q3=q3)


def person_mean(y, g, levels, place):
    return dict(mean=person_means(y, g, levels)[1][:, place - 1].mean())


def confusion(question, g, levels):
    truth, answer = columns[question + ".truth"], columns[question + ".answer"]
    keep = (truth != "") & (answer != "")
    if g:
        keep &= is_in(g, levels)
    truth, answer = truth[keep], answer[keep]
    n = len(truth)
    right = (truth == answer).sum()
    interval = stats.binomtest(int(right), n).proportion_ci(method="wilson")
    labels = set(truth) | set(answer)
    chance = sum((truth == label).sum() / n * ((answer == label).sum() / n) for label in labels)
    p = right / n
    return dict(
        n=n,
        accuracy=p,
        wilson_low=interval.low,
        wilson_high=interval.high,
        kappa=(p - chance) / (1 - chance),
    )


found = {}


def check(key, values):
    found.update({(key, name): float(value) for name, value in values.items()})


def holm(keys, into):
    """Holm's correction of the p of several checks together."""
    # A check that is itself the smallest of several counts with its corrected p.
    own = [found.get((key, "p_holm"), found[key, "p"]) for key in keys]
    for key, p in zip(into, adjusted(own)):
        found[key, "p_holm"] = float(p)


@CALLS@

with open("data/numbers-python.csv", "w", encoding="utf-8", newline="") as file:
    writer = csv.writer(file)
    writer.writerow(["key", "name", "value"])
    writer.writerows([key, name, repr(value)] for (key, name), value in found.items())
with open("data/numbers.csv", encoding="utf-8", newline="") as file:
    expected = [(row["key"], row["name"], float(row["value"])) for row in csv.DictReader(file)]
far = []
for key, name, value in expected:
    own = found.get((key, name), math.nan)
    size = max(abs(value), abs(own))
    if not abs(own - value) <= 1e-8 * size + (1e-12 if size > 1e-10 else 0.0):
        far.append(f"{key} {name}: {value!r}, here {own!r}")
print(f"{len(found)} numbers computed, {len(expected)} compared, {len(far)} differ")
if far:
    sys.exit("\n".join(far))
