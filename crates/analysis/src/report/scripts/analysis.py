"""The numbers of this report once more, by NumPy and SciPy.

    python analysis.py    computes and compares with data/numbers.csv

In: data/trials.csv (the trials in the analysis, after all exclusions) and data/numbers.csv (what
Mimique computed). Out: data/numbers-python.csv. Exit status 1 if a number differs by more than 1e-8
of its size or, where that is more, by more than its tolerance: maxima are found by a general optimiser,
and p of random draws are compared with draws of NumPy's.
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


def set_of(matched):
    """Matched sets: trials of one person that are equal in some columns."""
    return list(zip(person, *(columns[name] for name in matched)))


def set_means(matched, y, g, levels, among=True):
    """One mean per set (rows) and level (columns), only of the sets that a person has at every level."""
    v = number(y)
    keep = ~np.isnan(v) & is_in(g, levels) & among
    sets = set_of(matched)
    return means_by([sets[row] for row in np.flatnonzero(keep)], columns[g][keep], v[keep], levels)


def is_matched(matched, y, g, levels, among=True):
    """Whether each trial is of such a set."""
    whole = set(set_means(matched, y, g, levels, among)[0])
    is_whole = np.array([own in whole for own in set_of(matched)])
    return ~np.isnan(number(y)) & is_in(g, levels) & among & is_whole


def person_means(matched, y, g, levels):
    """Mean of each person (rows) at each level (columns) over the matched sets, to ten decimals, so that equal means have
    equal ranks; only people who have one."""
    sets, m = set_means(matched, y, g, levels)
    who = np.array([own[0] for own in sets], dtype=object)
    people = sorted(set(who))
    return people, np.array([np.round(m[who == one].sum(axis=0) / (who == one).sum(), 10) for one in people])


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


# The tests, each of them of plain arrays.


@TESTS@


# What is taken from the trials for a test.


def groups(values, labels, levels):
    split = [values[(labels == level) & ~np.isnan(values)] for level in levels]
    return [group for group in split if len(group)]


def by_unit(y, g, levels, unit):
    if unit == "trials":
        return groups(number(y), columns[g], levels)
    people, means = overall_means(y)
    return groups(means, about(g, people), levels)


def of_groups(test, y, g, levels, unit):
    return test(by_unit(y, g, levels, unit))


def adjusted(p):
    """Holm's correction."""
    corrected = np.empty(len(p))
    running = 0.0
    for place, i in enumerate(np.argsort(p, kind="stable")):
        running = max(running, (len(p) - place) * p[i])
        corrected[i] = min(1.0, running)
    return corrected


def of_differences_by_trait(test, matched, y, g, levels, a, b, trait, trait_levels):
    """Each person's difference between two levels, compared between groups of people."""
    people, m = person_means(matched, y, g, levels)

    def of_pair(i, j):
        return test(groups(np.round(m[:, i] - m[:, j], 9), about(trait, people), trait_levels))

    pairs = list(itertools.combinations(range(len(levels)), 2))
    p = adjusted([of_pair(*pair)["p"] for pair in pairs])
    return dict(**of_pair(a - 1, b - 1), p_holm=p[pairs.index((a - 1, b - 1))])


def of_columns(test, x, y, unit):
    if unit == "trials":
        return test(number(x), number(y))
    people, means = overall_means(y)
    first = {}
    for key, value in zip(person, number(x)):
        first.setdefault(key, value)
    return test(np.array([first[key] for key in people]), means)


def of_correlations(test, x, y, levels=None, matched=None):
    a, b = number(x), number(y)
    keep = ~np.isnan(a) & ~np.isnan(b)
    if levels is not None:
        keep &= is_matched(matched, y, x, levels)
    rho = []
    for one in sorted(set(person[keep])):
        own = keep & (person == one)
        if len(set(a[own])) > 1 and len(set(b[own])) > 1:
            ranks = stats.rankdata(a[own]), stats.rankdata(b[own])
            rho.append(np.corrcoef(*ranks)[0, 1])
    result = test(np.array(rho))
    return dict(statistic=result["statistic"], p=result["p"], effect=result["estimate"], n=result["n"])


def of_matched_trials(test, y, g, levels, matched):
    v = number(y)
    keep = ~np.isnan(v) & is_in(g, levels)
    keys = list(zip(person[keep], *(columns[name][keep] for name in matched)))
    _, m = means_by(keys, columns[g][keep], v[keep], levels)
    return test(m[:, 0] - m[:, 1])


def of_people(test, matched, y, g, levels, a, b):
    _, m = person_means(matched, y, g, levels)
    return test(m[:, a - 1] - m[:, b - 1])


def of_blocks(test, matched, y, g, levels):
    return test(person_means(matched, y, g, levels)[1])


def of_people_within(test, matched, y, g, levels, low, high):
    """Whether the difference of two levels within people lies between two bounds."""
    _, m = person_means(matched, y, g, levels)
    return test(m[:, 0] - m[:, 1], low, high)


def of_groups_within(test, y, g, levels, unit, low, high):
    """The same of two groups."""
    return test(by_unit(y, g, levels, unit), low, high)


def of_two_factors(test, y, a, a_levels, b, b_levels, effect, unit):
    v, of_a, of_b = number(y), columns[a], columns[b]
    if unit != "trials":
        people, v = overall_means(y)
        of_a, of_b = about(a, people), about(b, people)
    keep = ~np.isnan(v) & np.isin(of_a, a_levels) & np.isin(of_b, b_levels)
    return test(v[keep], of_a[keep], of_b[keep], effect)


def of_combinations(test, y, a, a_levels, b, b_levels, effect, matched_a, matched_b):
    """The means of each person and combination, over trials that are matched in both factors."""
    v = number(y)
    keep = is_matched(matched_a, y, a, a_levels)
    keep = is_matched(matched_b, y, b, b_levels, keep)
    keep = is_matched(matched_a, y, a, a_levels, keep)
    cells = np.empty(keep.sum(), dtype=object)
    cells[:] = list(zip(columns[a][keep], columns[b][keep]))
    pairs = sorted(set(cells))
    people, m = means_by(person[keep], cells, v[keep], pairs)
    of_a, of_b = (np.tile([pair[place] for pair in pairs], len(people)) for place in (0, 1))
    return test(m.ravel(), of_a, of_b, np.repeat(people, len(pairs)), effect)


def of_level(test, matched, y, g, level, levels):
    return test(number(y)[is_matched(matched, y, g, levels) & is_in(g, [level])])


mean = np.mean


def of_person_means(test, matched, y, g, levels, place):
    return dict(mean=test(person_means(matched, y, g, levels)[1][:, place - 1]))


def of_answers(test, question, g, levels):
    truth, answer = columns[question + ".truth"], columns[question + ".answer"]
    keep = (truth != "") & (answer != "")
    if g:
        keep &= is_in(g, levels)
    return test(truth[keep], answer[keep])


def of_detection(test, question, category, g, levels, matched=None, all_levels=None):
    """How well a category is told from all others, person by person; at some levels of a factor, or without one in
    all trials."""
    truth, answer = columns[question + ".truth"], columns[question + ".answer"]
    keep = (truth != "") & (answer != "")
    if g:
        keep &= is_in(g, levels)
    if matched is not None:
        keep &= is_matched(matched, question, g, all_levels)
    return test(person[keep].astype(str), truth[keep].astype(str), answer[keep].astype(str), category)


def detection_by(matched, what, question, category, g, levels):
    """d' or criterion of each person (rows) at each level (columns); only people who have all of them."""
    at = [of_detection(sensitivity, question, category, g, [level], matched, levels) for level in levels]
    people = sorted(set.intersection(*(set(own) for own in at)))
    m = np.array([[own[who][what] for own in at] for who in people])
    return m[~np.isnan(m).any(axis=1)]


def of_detection_blocks(test, matched, what, question, category, g, levels):
    return test(detection_by(matched, what, question, category, g, levels))


def of_detection_people(test, matched, what, question, category, g, levels, a, b):
    m = detection_by(matched, what, question, category, g, levels)
    return test(m[:, a - 1] - m[:, b - 1])


def clips_by_people(y, combine):
    """What is combined of each clip (rows) and person (columns); NaN where nothing was answered."""
    v = number(y)
    cells = {}
    for clip, who, value in zip(columns["stimulus"], person, v):
        if not math.isnan(value):
            cells.setdefault((clip, who), []).append(value)
    clips = sorted({clip for clip, _ in cells})
    people = sorted({who for _, who in cells})
    nothing = [math.nan]
    rows = [[combine(cells.get((clip, who), nothing)) for who in people] for clip in clips]
    return np.array(rows)


def of_clips_by_people(test, y):
    m = clips_by_people(y, np.mean)
    return test(m[~np.isnan(m).any(axis=1)])


def of_first_answers(test, y, level):
    return test(clips_by_people(y, lambda own: own[0]), level)


def of_items(test, items, reversed):
    """Items of a scale, a row per person; to turn an item round changes no more than its sign does."""
    by_person = []
    for item in items:
        sign = -1 if item in reversed else 1
        by_person.append({who: sign * mean for who, mean in zip(*overall_means(item))})
    people = [who for who in by_person[0] if all(who in own for own in by_person)]
    return test(np.array([[own[who] for own in by_person] for who in people]))


def choices_of(question, g, levels):
    """Choices between levels of a factor: who chose, the level on either side, the answer."""
    answer, own, other = columns[question + ".answer"], columns[g], columns["beside." + g]
    keep = (answer != "") & is_in(g, levels) & is_in("beside." + g, levels) & (own != other)
    other_left = columns["beside_side"][keep] == "left"
    left = np.where(other_left, other[keep], own[keep]).astype(str)
    right = np.where(other_left, own[keep], other[keep]).astype(str)
    return person[keep].astype(str), left, right, answer[keep].astype(str)


def of_choices(test, question, g, levels, side):
    return test(*choices_of(question, g, levels), side == 1)


def of_net_choices(test, question, g, levels, unit):
    """Choices of the first of two levels less those of the second, of each trial or person."""
    who, left, _, answer = choices_of(question, g, levels)
    net = (answer == "left").astype(float) - (answer == "right")
    net = np.where(left == levels[0], net, -net)
    if unit != "trials":
        net = np.array([net[who == one].sum() for one in np.unique(who)])
    return test(net)


def of_wins(test, question, g, levels):
    """How often each person (rows) chose each level (columns); a tie is half a choice."""
    who, left, right, answer = choices_of(question, g, levels)
    tie = (answer == "same") / 2

    def wins(one, level):
        on_left, on_right = ((who == one) & (side == level) for side in (left, right))
        return ((answer == "left") + tie)[on_left].sum() + ((answer == "right") + tie)[on_right].sum()

    return test(np.array([[wins(one, level) for level in levels] for one in np.unique(who)]))


def of_page_order(test, y, g, levels):
    """Which of every two levels was rated higher on the same page."""
    v, order = number(y), number("trial_order")
    keep = ~np.isnan(v) & is_in(g, levels)
    pages = {}
    for who, page, level, value in zip(person[keep], order[keep], columns[g][keep], v[keep]):
        pages.setdefault((who, page), {})[level] = value
    rows = []
    for (who, _), ratings in pages.items():
        for a, b in itertools.combinations([level for level in levels if level in ratings], 2):
            word = ["same", "left", "right"][int(np.sign(ratings[a] - ratings[b]))]
            rows.append((who, a, b, word))
    who, left, right, answer = (np.array(column, dtype=object) for column in zip(*rows))
    return test(who, left, right, answer, False)


def of_people_and_segments(test, matched, y, g, levels):
    """Ratings by the levels of a factor, over people and segments."""
    v = number(y)
    keep = is_matched(matched, y, g, levels) & (columns["segment"] != "")
    return test(v[keep], columns[g][keep], person[keep], columns["segment"][keep])


# Ratings of confidence, blocks that choose what is shown, and ratings that follow the clip.


@BLOCKS@


def given(test, p):
    """p of a mixed model as Mimique has found it: another program comes near it, not to the last digit."""
    return dict(p=p)


found = {}


def check(key, values):
    found.update({(key, name): float(value) for name, value in values.items()})


def holm(keys, into, hypothesis=None):
    """Holm's correction of the p of several checks together. Where a hypothesis has two p of which at most one can be
    wrong (equivalence and difference), a p counts for the hypotheses that are not settled by smaller p."""
    hypothesis = list(range(len(keys))) if hypothesis is None else hypothesis
    # A check that is itself the smallest of several counts with its corrected p.
    own = [found.get((key, "p_holm"), found[key, "p"]) for key in keys]
    places = np.argsort(own, kind="stable")
    running = 0.0
    for i, place in enumerate(places):
        still_open = len({hypothesis[other] for other in places[i:]})
        running = max(running, still_open * own[place])
        found[into[place], "p_holm"] = float(min(1.0, running))


@CALLS@

with open("data/numbers-python.csv", "w", encoding="utf-8", newline="") as file:
    writer = csv.writer(file)
    writer.writerow(["key", "name", "value"])
    writer.writerows([key, name, repr(value)] for (key, name), value in found.items())
with open("data/numbers.csv", encoding="utf-8", newline="") as file:
    expected = [(row["key"], row["name"], float(row["value"]), float(row["tolerance"])) for row in csv.DictReader(file)]
far = []
for key, name, value, tolerance in expected:
    own = found.get((key, name), math.nan)
    size = max(abs(value), abs(own))
    if not abs(own - value) <= max(1e-8 * size + (1e-12 if size > 1e-10 else 0.0), tolerance):
        far.append(f"{key} {name}: {value!r}, here {own!r}")
print(f"{len(found)} numbers computed, {len(expected)} compared, {len(far)} differ")
if far:
    sys.exit("\n".join(far))
