"""Writes rbf_scipy.json: a cubic RBF with an affine part on a face-like set of points (mm), by SciPy and
by 40-digit arithmetic."""
import json
import pathlib

import mpmath as mp
import numpy as np
from scipy.interpolate import RBFInterpolator

rng = np.random.default_rng(20170522)
# 5 x 8 places, each a little off its grid, as markers are placed on a face.
u, v = (a.ravel() for a in np.meshgrid(np.linspace(-1, 1, 5), np.linspace(-1, 1, 8)))
u, v = u + rng.uniform(-0.1, 0.1, 40), v + rng.uniform(-0.06, 0.06, 40)
actor = np.stack([70 * u, 95 * v, 60 * np.sqrt(np.maximum(0, 1.6 - u**2 - 0.5 * v**2))], axis=1)
actor = np.round(actor + rng.normal(0, 1.5, actor.shape), 4)
# Another face: other proportions, and a smooth bend of some millimetres.
bend = 5 * np.sin(actor[:, [1, 2, 0]] / 40) + rng.normal(0, 0.5, actor.shape)
avatar = np.round(actor * [0.93, 1.06, 1.01] + bend + [1, -2, 5], 4)
points = np.round(actor[:25] + rng.normal(0, 6, (25, 3)), 4)
scipy = RBFInterpolator(actor, avatar, kernel="cubic", degree=1)(points)

mp.mp.dps = 40
n = len(actor)


def cubed(a, b):
    return mp.sqrt(sum((mp.mpf(float(x)) - mp.mpf(float(y))) ** 2 for x, y in zip(a, b))) ** 3


def by_forty_digits(smoothing):
    system, right = mp.matrix(n + 4, n + 4), mp.matrix(n + 4, 3)
    for i in range(n):
        for j in range(n):
            system[i, j] = cubed(actor[i], actor[j])
        system[i, i] += smoothing
        for k, x in enumerate([*actor[i], 1.0]):
            system[i, n + k] = system[n + k, i] = mp.mpf(float(x))
        for k in range(3):
            right[i, k] = mp.mpf(float(avatar[i][k]))
    columns = [mp.lu_solve(system, right[:, k]) for k in range(3)]
    basis = [[cubed(p, c) for c in actor] + [mp.mpf(float(x)) for x in [*p, 1.0]] for p in points]
    rows = [[float(sum(u * b for u, b in zip(column, row))) for column in columns] for row in basis]
    return np.array(rows)


exact = by_forty_digits(0)
print("SciPy against exact", np.abs(scipy - exact).max(), "mm")

# A smoothing of 0.1 for points that are centred and scaled to a root mean square radius of 1.
middle = actor.mean(axis=0)
radius = np.sqrt(((actor - middle) ** 2).sum(axis=1).mean())
smooth_scipy = RBFInterpolator(
    (actor - middle) / radius, avatar, kernel="cubic", degree=1, smoothing=0.1
)((points - middle) / radius)
smooth = by_forty_digits(mp.mpf(1) / 10 * mp.mpf(float(radius)) ** 3)
print("smoothed", np.abs(smooth_scipy - smooth).max(), "mm, moves by", np.abs(smooth - exact).max())
out = {
    "actor": actor,
    "avatar": avatar,
    "points": points,
    "scipy": scipy,
    "exact": exact,
    "smooth_scipy": smooth_scipy,
    "smooth": smooth,
}
text = json.dumps({key: value.tolist() for key, value in out.items()})
pathlib.Path(__file__).with_suffix(".json").write_text(text + "\n")
