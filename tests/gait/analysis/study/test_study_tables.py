"""Reliability, agreement, one against a group, power, mixed models and workbook against independent references."""

import csv
import zlib

import numpy as np
import pytest
from scipy import stats
from scipy.integrate import quad

from plantar import InputError
from plantar.gait.analysis.study.definitions import definition_of
from plantar.gait.analysis.study.one_against_group import standing_of
from plantar.gait.analysis.study.reliability import agreement_of, reliability_of
from plantar.gait.analysis.study.run_study import run_study
from plantar.gait.analysis.study.sample_size import people_needed, power_of
from plantar.gait.analysis.study.statistics import effect_of
from plantar.gait.analysis.study.study_options import StudyOptions
from plantar.gait.analysis.study.workbook import write_workbook

from ..walks import made_walk


def seeded(name: str) -> np.random.Generator:
    return np.random.default_rng(zlib.crc32(name.encode()))


def test_reliability_is_that_of_a_least_squares_anova():
    """Mean squares from sums of squares of nested linear models, and McGraw & Wong's interval by scipy.stats."""
    random = seeded("icc")
    n = 12
    k = 3
    values = random.normal(size=(n, 1)) * 3.0 + random.normal(size=(1, k)) + random.normal(size=(n, k))
    y = values.ravel()
    people = (np.repeat(np.arange(n), k)[:, None] == np.arange(n)).astype(float)
    trials = (np.tile(np.arange(k), n)[:, None] == np.arange(k)).astype(float)

    def rest(*columns):
        x = np.column_stack([np.ones(n * k), *columns])
        return float(((y - x @ np.linalg.lstsq(x, y, rcond=None)[0]) ** 2).sum())

    error = rest(people, trials) / ((n - 1) * (k - 1))
    msr = (rest(trials) - rest(people, trials)) / (n - 1)
    msc = (rest(people) - rest(people, trials)) / (k - 1)
    icc = (msr - error) / (msr + (k - 1) * error + k * (msc - error) / n)
    found = reliability_of(values)
    assert found.icc_2_1 == pytest.approx(icc, rel=1e-9)
    assert found.icc_2_k == pytest.approx((msr - error) / (msr + (msc - error) / n), rel=1e-9)
    assert found.mdc95 == pytest.approx(
        stats.norm.ppf(0.975) * np.sqrt(2 * (error + max(0, msc - error) / n)), rel=1e-9
    )
    a = k * icc / (n * (1 - icc))
    b = 1 + k * icc * (n - 1) / (n * (1 - icc))
    v = (a * msc + b * error) ** 2 / ((a * msc) ** 2 / (k - 1) + (b * error) ** 2 / ((n - 1) * (k - 1)))
    f = stats.f.ppf(0.975, n - 1, v)
    low = n * (msr - f * error) / (f * (k * msc + (k * n - k - n) * error) + n * msr)
    assert found.icc_2_1_low == pytest.approx(low, rel=1e-9)
    assert found.icc_2_1_low < icc < found.icc_2_1_high


def test_limits_of_agreement_hold_95_of_100_new_differences():
    """Of three pairs a person whose differences vary between people and within them."""
    random = seeded("limits")
    inside = []
    for _ in range(100):
        truth = random.normal(0.0, 1.0, 25)
        pairs = [np.column_stack([np.zeros(3), 0.3 + t + random.normal(0.0, 0.7, 3)]) for t in truth]
        found = agreement_of(pairs)
        new = 0.3 + random.normal(0.0, np.hypot(1.0, 0.7), 200)
        inside.append(np.mean((new > found.low) & (new < found.high)))
    assert np.mean(inside) == pytest.approx(0.95, abs=0.02)


def test_limits_of_single_pairs_are_bland_and_altmans():
    random = seeded("single")
    a, b = random.normal(size=(2, 15))
    found = agreement_of([np.array([[x, y]]) for x, y in zip(a, b, strict=True)])
    spread = stats.norm.ppf(0.975) * (b - a).std(ddof=1)
    assert (found.low, found.high) == pytest.approx(((b - a).mean() - spread, (b - a).mean() + spread), rel=1e-9)
    line = stats.linregress((a + b) / 2, b - a)
    assert (found.slope, found.slope_p) == pytest.approx((line.slope, line.pvalue), rel=1e-9)


def test_one_against_a_group_is_crawford_and_howells():
    random = seeded("crawford")
    group = random.normal(100.0, 15.0, 18)
    value = 60.0
    found = standing_of(value, group)
    # Their t is Student's of two samples of which one is of size one.
    assert found.t == pytest.approx((value - group.mean()) / (group.std(ddof=1) * np.sqrt(19 / 18)), rel=1e-9)
    assert found.p == pytest.approx(2 * stats.t.cdf(-abs(found.t), 17), rel=1e-9)
    scaled = np.sqrt(18) * (value - group.mean()) / group.std(ddof=1)
    for share, at in ((found.below_low, 0.975), (found.below_high, 0.025)):
        # A noncentral t below a value, by its definition: a normal over the root of a chi-squared.
        d = stats.norm.ppf(0.01 * share) * np.sqrt(18)
        below = quad(
            lambda x, d=d: stats.norm.cdf(scaled * np.sqrt(x / 17) - d) * stats.chi2.pdf(x, 17), 0, 120, epsabs=1e-13
        )[0]
        assert below == pytest.approx(at, abs=1e-9)


def test_a_range_of_the_group_holds_95_of_100_people():
    random = seeded("range")
    held = [found.low < found.value < found.high for found in (
        standing_of(float(random.normal()), random.normal(size=8)) for _ in range(2000)
    )]  # fmt: skip
    assert np.mean(held) == pytest.approx(0.95, abs=0.02)


@pytest.mark.parametrize("paired", [True, False])
def test_power_is_that_of_statsmodels(paired):
    power = pytest.importorskip("statsmodels.stats.power")
    theirs = power.TTestPower() if paired else power.TTestIndPower()
    assert power_of(0.6, 20, paired) == pytest.approx(theirs.power(0.6, 20, 0.05), abs=1e-9)
    random = seeded(f"power {paired}")
    a, b = random.normal(size=(2, 12))
    effect = effect_of(a, b - b.mean() + a.mean() + 0.7, paired, 1.0, 1.0)
    size = effect.difference / (effect.error * np.sqrt(12 if paired else 6))
    wanted = theirs.solve_power(size, power=0.8, alpha=0.05)
    assert people_needed(effect) == int(np.ceil(np.atleast_1d(wanted)[0]))


def test_a_large_difference_takes_few_people():
    """A noncentral t of a huge difference is no number; a search from above called 74."""
    effect = effect_of(np.arange(20.0), np.arange(20.0) + 50.0 + 0.1 * np.sin(np.arange(20)), True, 1.0, 1.0)
    assert people_needed(effect) == 2


def test_a_balanced_mixed_model_is_the_paired_test_of_means():
    """REML of a constant for each person and level in it: closed form where the variances are inside their range."""
    pytest.importorskip("statsmodels")
    from plantar.gait.analysis.study.mixed_models import fit_mixed

    random = seeded("mixed")
    n = 20
    k = 12
    who = np.repeat(np.arange(n), 2 * k)
    level = np.tile(np.repeat([0, 1], k), n)
    noise = random.normal(0.0, 4.0, n * 2 * k) + np.repeat(random.normal(0.0, 5.0, 2 * n), k)
    values = 100.0 + np.repeat(random.normal(0.0, 10.0, n), 2 * k) + noise + 2.0 * level
    fit = fit_mixed(values, level, who, np.zeros((len(values), 0)))
    means = values.reshape(n, 2, k).mean(axis=2)
    change = means[:, 1] - means[:, 0]
    assert fit.differences[0] == pytest.approx(change.mean(), rel=1e-4)
    assert fit.errors[0] == pytest.approx(change.std(ddof=1) / np.sqrt(n), rel=1e-4)
    within = values.reshape(n, 2, k).var(axis=2, ddof=1).mean()
    assert fit.spreads[2] == pytest.approx(np.sqrt(within), rel=1e-4)


def test_a_workbook_holds_texts_as_texts(tmp_path):
    pytest.importorskip("xlsxwriter")
    openpyxl = pytest.importorskip("openpyxl")
    rows = [{"recording": "=1+1", "peak_force_N": 700.5}, {"recording": "b", "peak_force_N": float("nan")}]
    write_workbook(tmp_path / "a.xlsx", {"recordings": (["recording", "peak_force_N"], rows)})
    book = openpyxl.load_workbook(tmp_path / "a.xlsx")
    assert list(book["recordings"].values) == [("recording", "peak_force_N"), ("=1+1", 700.5), ("b", None)]
    assert book["recordings"]["A2"].data_type == "s"
    assert ("peak_force_N", "Peak force", "N") in list(book["definitions"].values)
    assert definition_of("heel.impulse_Ns") == ("Heel: force-time integral", "N s")


def test_a_table_longer_than_a_sheet_goes_on_in_the_next(tmp_path, monkeypatch):
    pytest.importorskip("xlsxwriter")
    openpyxl = pytest.importorskip("openpyxl")
    monkeypatch.setattr("plantar.gait.analysis.study.workbook.MOST_ROWS", 2)
    rows = [{"step": k} for k in range(5)]
    write_workbook(tmp_path / "a.xlsx", {"s" * 40: (["step"], rows)})
    book = openpyxl.load_workbook(tmp_path / "a.xlsx")
    parts = ["s" * 31, "s" * 29 + " 2", "s" * 29 + " 3"]
    assert book.sheetnames == ["definitions", *parts]
    assert [row for name in parts for row in list(book[name].values)[1:]] == [(k,) for k in range(5)]
    with pytest.raises(InputError, match="a text of 40000 characters"):
        write_workbook(tmp_path / "b.xlsx", {"a": (["x"], [{"x": "y" * 40_000}])})
    assert not (tmp_path / "b.xlsx").exists()


@pytest.fixture(scope="module")
def planted(tmp_path_factory):
    """Seven people, two shoes, two trials: the left forefoot carries more in the second; speed is in the table."""
    folder = tmp_path_factory.mktemp("planted") / "recordings"
    folder.mkdir()
    random = seeded("planted")
    lines = ["file,participant,condition,mass_kg,affected,trial,speed"]
    for who in range(7):
        weight = random.normal(700.0, 60.0)
        for shoe in ("flat", "stiff"):
            for trial in (1, 2):
                options = {
                    "rate": 50.0,
                    "strides": 4,
                    "seed": who,
                    "noise": 0.2,
                    "weight": weight * random.normal(1, 0.01),
                }
                walk = made_walk(**options).recording
                arrays = {side: walk.feet[side].force.copy() for side in ("left", "right")}
                layout = walk.feet["left"].layout
                front = layout.positions[:, 0] > 0.7 * layout.outline[:, 0].max()
                if shoe == "stiff":
                    arrays["left"][:, front] *= 1.3
                name = f"p{who}_{shoe}_{trial}.npz"
                np.savez(folder / name, time=walk.time, unit="N", **arrays)
                speed = random.normal(1.3, 0.1)
                lines.append(
                    f"{name},p{who},{shoe},{weight / 9.81:.2f},{('left', 'right')[who % 2]},{trial},{speed:.3f}"
                )
    table = folder / "table.csv"
    table.write_text("\n".join(lines) + "\n")
    return folder, table


def test_a_study_of_two_factors_finds_what_is_planted_where_it_is(planted, tmp_path):
    folder, table = planted
    out = tmp_path / "out"
    with pytest.raises(InputError, match=r"--factor shoe: no recording has it; allowed: condition, side, affected"):
        run_study(folder, out, table, figures=False, plan=StudyOptions(factors=("shoe",)))
    plan = StudyOptions(("condition", "side"), margin_percent=10.0, patient="p0")
    study = run_study(folder, out, table, plan=plan)
    first = study.comparisons[0]
    assert (first.factor, first.a, first.b) == ("condition", "flat", "stiff")
    (change,) = study.changes
    assert (change.factor, change.a, change.b) == ("side (change from flat to stiff)", "left", "right")
    assert change.effects == {} or "stance_percent" in change.effects
    assert set(study.reliability) == {"flat", "stiff"}
    assert next(iter(study.reliability["flat"].values())).k == 2
    with (out / "patient.csv").open() as stream:
        assert {row["side"] for row in csv.DictReader(stream)} == {"left", "right"}
    page = (out / "patient.html").read_text()
    assert "6 people of the others" in page
    assert "takes 19 or more" in page.replace("takes a group of ", "takes ")
    assert "Reliability" in (out / "study.html").read_text()


@pytest.mark.long
def test_processes_measure_what_one_does(planted, tmp_path):
    folder, table = planted
    one, two = (
        run_study(folder, tmp_path / str(jobs), table, figures=False, plan=StudyOptions(jobs=jobs)) for jobs in (1, 2)
    )
    assert one.summary() == two.summary()
    assert (tmp_path / "1" / "steps.csv").read_bytes() == (tmp_path / "2" / "steps.csv").read_bytes()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"factors": ()}, "--factor: allowed: one name or more"),
        ({"factors": ("side", "side")}, "a name is given twice"),
        ({"margin_percent": 0.0}, "--margin is 0; allowed: above 0, up to 100 %"),
        ({"norm": "healthy"}, "--norm is the group that --patient is compared with"),
        ({"jobs": 0}, "--jobs is 0; allowed: 1 to 256"),
    ],
)
def test_options_that_make_no_sense_are_refused(options, message):
    with pytest.raises(InputError, match=message):
        StudyOptions(**options)


def test_an_unbalanced_mixed_model_with_a_covariate_is_that_of_its_likelihood():
    """Restricted likelihood of the covariance of all steps, by another search; people lack levels and steps."""
    pytest.importorskip("statsmodels")
    from scipy.optimize import minimize

    from plantar.gait.analysis.study.mixed_models import fit_mixed

    random = seeded("unbalanced")
    cells = [(who, level) for who in range(9) for level in range(3) if (who, level) not in ((2, 1), (5, 2))]
    who, level = np.repeat(np.array(cells), random.integers(3, 8, len(cells)), axis=0).T
    speed = random.normal(1.2, 0.1, len(who))
    of_cell = who * 3 + level
    values = 5.0 * speed + 0.7 * level + random.normal(0.0, 1.0, 9)[who] + random.normal(0.0, 0.5, 27)[of_cell]
    values = values + random.normal(0.0, 0.4, len(who))
    x = np.column_stack([np.ones(len(who)), level == 1, level == 2, speed]).astype(float)
    alike = [(each[:, None] == each).astype(float) for each in (who, of_cell)]

    def solved(logs):
        people, levels, steps = np.exp(2.0 * np.asarray(logs))
        inverse = np.linalg.inv(people * alike[0] + levels * alike[1] + steps * np.eye(len(who)))
        information = x.T @ inverse @ x
        beta = np.linalg.solve(information, x.T @ inverse @ values)
        rest = values - x @ beta
        loss = -np.linalg.slogdet(inverse)[1] + np.linalg.slogdet(information)[1] + rest @ inverse @ rest
        return loss, beta, information

    best = minimize(lambda logs: solved(logs)[0], np.log([1.0, 0.5, 0.4]), method="Nelder-Mead", tol=1e-10)
    _, beta, information = solved(best.x)
    found = fit_mixed(values, level, who, speed[:, None])
    assert found.levels == (1, 2)
    assert found.differences == pytest.approx(beta[1:3], rel=1e-4)
    assert found.errors == pytest.approx(np.sqrt(np.diag(np.linalg.inv(information)))[1:3], rel=1e-4)
    assert found.spreads == pytest.approx(np.exp(best.x), rel=1e-3)
