def of_confidence(test, question, confidence, category):
    """How surely each person answered, and a category."""
    truth, answer, sure = columns[question + ".truth"], columns[question + ".answer"], number(confidence)
    keep = (truth != "") & (answer != "") & ~np.isnan(sure)
    return test(person[keep].astype(str), truth[keep].astype(str), answer[keep].astype(str), sure[keep], category)


def of_block(block):
    """The trials of a block; no face that the seed does not give again is among them."""
    return columns["shown.block"] == block


def of_answers_by_level(test, question, block, who, shape, sign, guess):
    """The psychometric function of a person; where levels fall they count with a minus."""
    own = of_block(block) & (person == who)
    own[own] = (columns["shown.catch"][own] == "0") & (columns[question + ".right"][own] != "")
    level, place = np.unique(sign * columns["shown.level"][own].astype(float), return_inverse=True)
    right = columns[question + ".right"][own].astype(float)
    fit = test(level, np.bincount(place).astype(float), np.bincount(place, right), guess, None, shape)
    return dict(fit, threshold=sign * fit["threshold"])


def of_found(test, keys, given, low, high):
    """Thresholds found above, and given ones where the answers leave the spread open; those that lie within the levels."""
    values = np.array([found[key, "threshold"] for key in keys] + [float(value) for value in given])
    return test(values[(values >= low) & (values <= high)])


def of_judgements(test, question, block, second):
    """Judgements of differences between levels; `second` is the answer that the second pair differs more."""
    own = of_block(block) & (columns[question + ".answer"] != "")
    levels = np.array([[float(level) for level in cell.split()] for cell in columns["shown.levels"][own]])
    return test(levels, (columns[question + ".answer"][own] == second).astype(float))


def height(course, times):
    """How high a unit is at a time: from 0 at its onset to its peak, and back to 0."""
    onset, peak, offset, amplitude, acceleration, deceleration = course

    def step(x, half):
        y = np.clip(x, 0, 1) ** (math.log(0.5) / math.log(half))
        return y**3 * (10 + y * (6 * y - 15))

    rise = step((times - onset) / (peak - onset), acceleration)
    fall = 1 - step((times - peak) / (offset - peak), deceleration)
    return amplitude * np.where(times <= peak, rise, fall) * ((times > onset) & (times < offset))


def of_faces(test, question, block, category, units, bins, duration):
    """Faces drawn at random: what each unit (of 0 bins: its presence, else its height in each time bin) has to do with
    an answer."""
    own = of_block(block) & (columns[question + ".answer"] != "")
    width = max(bins, 1)
    times = (np.arange(width) + 0.5) * duration / width
    cells = np.zeros((own.sum(), len(units), width))
    for trial, cell in enumerate(columns["shown.courses"][own]):
        for unit, *course in (text.split() for text in cell.split(";") if text):
            if unit in units:
                own_height = height([float(number) for number in course], times) if bins else 1.0
                cells[trial, units.index(unit)] = own_height
    said = columns[question + ".answer"][own] == category
    result = test(person[own].astype(str), cells.reshape(len(cells), -1), said)
    of_cells = [f"{unit}.{place + 1}" for unit in units for place in range(width)]
    return {f"{name}.{cell}": value for name, values in result.items() for cell, value in zip(of_cells, values)}


courses = {}


def of_course(test, matched, y, g, levels, level, instant):
    """Where a rating that follows the clip stands at an instant (from 1), one mean per person."""
    if y not in courses:
        courses[y] = [[float(value) for value in cell.split()] for cell in columns[y + ".trace"]]
    there = [(who, own[instant - 1]) for who, own, is_level in zip(person, courses[y], is_in(g, [level]) & is_matched(matched, y, g, levels))
             if is_level and len(own) >= instant]
    who, values = zip(*there)
    _, means = means_by(who, ["all"] * len(who), values, ["all"])
    return test(means[:, 0])


def mean_and_interval(values):
    """The mean over people with its t interval."""
    n, mean = len(values), np.mean(values)
    reach = stats.t.ppf(0.975, n - 1) * np.std(values, ddof=1) / math.sqrt(n) if n > 1 else math.nan
    return dict(mean=mean, low=mean - reach, high=mean + reach, n=n)


def mean_courses(matched, y, g, levels, level):
    own = is_in(g, [level]) & (columns[y + ".trace"] != "") & is_matched(matched, y, g, levels)
    people = {}
    for who, cell in zip(person[own], columns[y + ".trace"][own]):
        people.setdefault(who, []).append([float(value) for value in cell.split()])
    shortest = {who: min(map(len, all)) for who, all in people.items()}
    return {who: np.mean([one[: shortest[who]] for one in all], axis=0) for who, all in people.items()}


def of_courses(test, matched, y, g, levels, a, b):
    """Differences of people's mean courses between two levels, over the instants that everybody has."""
    of_a, of_b = (mean_courses(matched, y, g, levels, level) for level in (a, b))
    people = [who for who in of_a if who in of_b]
    n = min((min(len(of_a[who]), len(of_b[who])) for who in people), default=0)
    return test(np.array([of_a[who][:n] - of_b[who][:n] for who in people]))
