"""The peers of `cargo xtask bench --annotate`: scikit-learn and hmmlearn, one measurement a line of input.

    python annotation.py PROBLEM_FOLDER

The folder is written by crates/annotate/benches/peers.rs. Each line of standard input is answered with
{"seconds": processor time, "answer": a number that both sides find}.
"""

import json
import sys
import time
import warnings
from pathlib import Path

import hmmlearn
import numpy as np
import sklearn
from hmmlearn.hmm import GMMHMM
from sklearn.ensemble import RandomForestClassifier
from sklearn.neighbors import KNeighborsClassifier
from sklearn.svm import SVC

warnings.filterwarnings("ignore")
folder = Path(sys.argv[1])
SHAPES, COMPONENTS = 51, 20


def read(name):
    return np.fromfile(folder / f"{name}.f64", dtype="<f8")


train = read("train").reshape(-1, SHAPES)
labels = read("labels").astype(int)
asked = read("asked").reshape(-1, SHAPES)
learnt = read("learnt").reshape(-1, SHAPES)


def model(name, **options):
    start = read(f"{name}-start")
    states = len(start)
    hmm = GMMHMM(
        n_components=states, n_mix=COMPONENTS, covariance_type="diag", init_params="", **options
    )
    hmm.startprob_ = start
    hmm.transmat_ = read(f"{name}-transition").reshape(states, states)
    hmm.weights_ = read(f"{name}-weight").reshape(states, COMPONENTS)
    hmm.means_ = read(f"{name}-mean").reshape(states, COMPONENTS, SHAPES)
    hmm.covars_ = read(f"{name}-variance").reshape(states, COMPONENTS, SHAPES)
    hmm.n_features = SHAPES
    return hmm


joined = model("joined")
svm = SVC(C=1, gamma=0.2, tol=1e-3, decision_function_shape="ovo", cache_size=200)
forest = RandomForestClassifier(200, random_state=1, n_jobs=1, oob_score=True)


def timed(work):
    start = time.process_time()
    found = work()
    return time.process_time() - start, found


def viterbi():
    return timed(lambda: joined.decode(asked, algorithm="viterbi")[0])


def posteriors():
    return timed(lambda: joined.score_samples(asked)[0])


def baum_welch():
    # Its training has priors and takes variances about the old means: the step costs the same.
    one = model("one", n_iter=1, tol=0)
    seconds, _ = timed(lambda: one.fit(learnt))
    return seconds, one.monitor_.history[0]


def neighbours():
    def work():
        return KNeighborsClassifier(15, algorithm="brute").fit(train, labels).predict(asked).mean()

    return timed(work)


def rbf_fit():
    seconds, _ = timed(lambda: svm.fit(train, labels))
    return seconds, 0.0


def rbf_decisions():
    svm.fit(train, labels)
    return timed(lambda: svm.decision_function(asked).mean())


def forest_fit():
    seconds, _ = timed(lambda: forest.fit(train, labels))
    return seconds, forest.oob_score_


def forest_answers():
    forest.fit(train, labels)
    return timed(lambda: forest.predict_proba(asked)[:, 0].mean())


runs = {
    "viterbi": viterbi,
    "posteriors": posteriors,
    "baum-welch": baum_welch,
    "neighbours": neighbours,
    "rbf fit": rbf_fit,
    "rbf decisions": rbf_decisions,
    "forest fit": forest_fit,
    "forest answers": forest_answers,
}
versions = {"hmmlearn": hmmlearn.__version__, "sklearn": sklearn.__version__, "numpy": np.__version__}
print(json.dumps(versions), flush=True)
for line in sys.stdin:
    seconds, answer = runs[line.strip()]()
    print(json.dumps({"seconds": seconds, "answer": float(answer)}), flush=True)
