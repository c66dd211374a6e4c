"""The peers of `cargo xtask bench`: the same optima by SciPy, one measurement a line of input.

    python solvers.py PROBLEM_FOLDER

The folder is written by crates/stimulus/benches/figures.rs. First the peers' answers are compared
with ours; then each line of standard input (lsts, lsts-norm, lsts-norm-default) is answered with
{"units": frames, "seconds": processor time}.
"""

import json
import sys
import time
from pathlib import Path

import numpy as np
import scipy
from scipy.optimize import lsq_linear, minimize

folder = Path(sys.argv[1])
problem = json.loads((folder / "problem.json").read_text())
n, rows = problem["shapes"], problem["rows"]
l2, tau, kappa = problem["l2"], problem["tau"], problem["kappa"]
lo, hi, s = problem["lo"], problem["hi"], problem["s"]


def read(name, width):
    return np.fromfile(folder / name, dtype="<f8").reshape(-1, width)


D = read("marker_deltas.f64", n)
H = read("shell_gram.f64", n)
displacements = read("displacements.f64", rows)

# lsts as a 53 x 53 least-squares problem: the triangle of its Hessian, made once.
alpha = problem["alpha"]["lsts"]
triangle = np.linalg.cholesky(D.T @ D / l2 + kappa * alpha * H / tau).T
right = np.linalg.solve(triangle.T, D.T @ displacements.T / l2).T


def lsts():
    """lsq_linear(method="bvls"), cold, on every frame."""
    return np.array(
        [lsq_linear(triangle, y, bounds=(0, 1), method="bvls", tol=1e-12).x for y in right]
    )


norm_alpha = problem["alpha"]["lsts-norm"]
length = np.sqrt(l2)
shell = norm_alpha / tau * H
bounds = (1 - norm_alpha) / n


def norm(c, d):
    """Value and gradient of lsts-norm: the norm of the residual, the shell, the soft bounds."""
    residual = D @ c - d
    size = np.sqrt(residual @ residual)
    bend = shell @ c
    below, above = np.exp((lo - c) / s), np.exp((c - hi) / s)
    value = size / length + c @ bend + bounds * (below.sum() + above.sum())
    gradient = D.T @ residual / (size * length) + 2 * bend + bounds / s * (above - below)
    return value, gradient


def lsts_norm(**options):
    """L-BFGS-B with H precomputed and the gradient given, cold, on every frame."""
    start = np.zeros(n)
    return np.array(
        [
            minimize(norm, start, args=(d,), jac=True, method="L-BFGS-B", options=options).x
            for d in displacements
        ]
    )


def tight():
    return lsts_norm(ftol=0.0, gtol=1e-10, maxiter=20_000, maxfun=20_000)


runs = {"lsts": lsts, "lsts-norm": tight, "lsts-norm-default": lsts_norm}

worst = {}
for name, run in runs.items():
    ours = read(f"{name.removesuffix('-default')}.f64", n)
    worst[name] = float(np.abs(run() - ours).max())
print(
    json.dumps(
        {
            "numpy": np.__version__,
            "scipy": scipy.__version__,
            "python": sys.version.split()[0],
            "frames": len(displacements),
            "worst": worst,
        }
    ),
    flush=True,
)

for line in sys.stdin:
    run = runs[line.strip()]
    start = time.process_time()
    run()
    seconds = time.process_time() - start
    print(json.dumps({"units": len(displacements), "seconds": seconds}), flush=True)
