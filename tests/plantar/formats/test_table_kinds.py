"""Tables of forces by any sensible heading, and text formats of laboratories: columns are taken by what they hold."""

import re
from collections.abc import Sequence

import numpy as np
import pytest

from plantar import FormatError
from plantar.formats import read_recording
from plantar.formats.format import ReadOptions
from plantar.gait.analysis.analyse import Analysis, analyse

TIME = np.arange(0.0, 8.0, 0.01)
PERIOD, STANCE, WEIGHT = 1.1, 0.62, 700.0


def foot(phase: float) -> tuple[np.ndarray, np.ndarray]:
    """Vertical force (n,) in N of a walking foot, and how far each of its contacts has gone (0 to 1)."""
    share = ((TIME + phase) % PERIOD) / PERIOD / STANCE
    inside = np.clip(share, 0.0, 1.0)
    humps = np.sin(np.pi * inside) + 0.25 * np.sin(3.0 * np.pi * inside)
    return np.where(share < 1.0, 800.0 * humps / humps.max(), 0.0), inside


(LEFT, GONE_LEFT), (RIGHT, GONE_RIGHT) = foot(0.2), foot(0.75)
NONE = np.zeros_like(TIME)
WALK = list(zip(TIME, LEFT, RIGHT, strict=True))
AHEAD = {"left": 0.2 * LEFT * (GONE_LEFT - 0.5), "right": 0.2 * RIGHT * (GONE_RIGHT - 0.5)}
LEFTWARD = {"left": -0.04 * LEFT, "right": 0.04 * RIGHT}
PLACE = {"left": 0.2 * GONE_LEFT, "right": 0.2 * GONE_RIGHT}

HEADINGS = re.split(
    r";\s+",
    """Left Fz (N)|Right Fz (N); Fz_left|Fz_right; FzL|FzR; L_Fz|R_Fz; vGRF_L|vGRF_R; GRF left [N]|GRF right [N];
Fz1|Fz2; FP1_Fz|FP2_Fz; ground_force_l_vy|ground_force_r_vy; Force.Fz1|Force.Fz2; Left Force|Right Force; GRFz_L|GRFz_R;
LeftVerticalForce_N|RightVerticalForce_N; Belt1 Fz|Belt2 Fz; Kraft links [N]|Kraft rechts [N]; F1Y1|F2Y1;
Left total force(N)|Right total force(N); Force Z (Left)|Force Z (Right); Left [N]|Right [N]; LFoot_Fz|RFoot_Fz;
Treadmill Left Fz|Treadmill Right Fz; Plate 1 Vertical (N)|Plate 2 Vertical (N); fz_left_newton|fz_right_newton;
force_sum_left|force_sum_right; Forza sinistra (N)|Forza destra (N); Kracht links (N)|Kracht rechts (N);
Linker Fuß Kraft [N]|Rechter Fuß Kraft [N]; Kraft li (N)|Kraft re (N);
Force verticale pied gauche [N]|Force verticale pied droit [N]; Fuerza vertical izq (N)|Fuerza vertical der (N);
Pie izquierdo (N)|Pie derecho (N); Piede sinistro [N]|Piede destro [N]; Linkervoet [N]|Rechtervoet [N];
Força esquerda (N)|Força direita (N); 左足 荷重 (N)|右足 荷重 (N); PlateA Fz|PlateB Fz;
Noraxon Insoles.LT Force-Total (N)|Noraxon Insoles.RT Force-Total (N)""",
)


def rows(columns: Sequence[np.ndarray], sign: str = "\t") -> str:
    return "\n".join(sign.join(f"{v:.6f}" for v in row) for row in np.column_stack(list(columns)))


def check(walk: Analysis, sides: Sequence[str] = ("left", "right"), weight: float = 800.0) -> None:
    assert sorted(walk.feet) == sorted(sides)
    assert walk.metrics["activity"]["name"] == "walking"
    for side in sides:
        gait = walk.feet[side]
        truth = {"left": LEFT, "right": RIGHT}[side]
        first = TIME[np.flatnonzero(np.diff((truth > 0.0).astype(int)) == 1)[0]]
        assert len(gait.steps) in (6, 7)
        assert abs(gait.steps[0].heel_strike_s - first) < 0.02
        assert np.median([s["contact_time_s"] for s in gait.steps]) == pytest.approx(PERIOD * STANCE, abs=0.012)
        assert max(s["peak_force_N"] for s in gait.steps) == pytest.approx(weight, rel=0.01)
    if len(sides) == 2:
        assert walk.metrics["gait"]["double_support_percent"] == pytest.approx(24.0, abs=2.0)
        assert walk.metrics["gait"]["cadence_steps_per_min"] == pytest.approx(120.0 / PERIOD, rel=0.003)


def test_the_reactions_of_orthotrak_stand_among_joint_forces_and_muscles(tmp_path):
    names = []
    columns = []
    for side, force in (("R", RIGHT), ("L", LEFT)):
        names += [f"{side}_KNEE Flex FRC", f"{side}_GRF_FWD", f"{side}_GRF_LAT", f"{side}_GRF_VRT", f"{side} GRF"]
        columns += [0.7 * force, AHEAD["right"], 0.05 * force, force, 40.0 + 300.0 * np.abs(np.sin(7.0 * TIME))]
    head = "Version\t3.0\nStarting Frame\t12\nR_Velocity\t131.5\nRHS\t35.0\t145.0\n"
    path = tmp_path / "report.xls"
    path.write_text(head + "\t".join(names) + "\n" + rows(columns))
    check(analyse(path, rate_hz=100.0))


@pytest.mark.parametrize("names", HEADINGS)
def test_headings_of_two_feet(tmp_path, names):
    path = tmp_path / "walk.csv"
    path.write_text("Time (s)," + names.replace("|", ",") + "\n" + rows([TIME, LEFT, RIGHT], ","))
    check(analyse(path))


@pytest.mark.sample(16)
@pytest.mark.parametrize("above", ["Rate,100", "Sampling frequency (Hz),100,,", "Name,Max,,|rate,100,Hz,", "Name,Max"])
@pytest.mark.parametrize(
    "names", ["left,right", "L_Fz,R_Fz", "Fz Left,Fz Right", "left_force,right_force", "L1,L2,R1,R2", "L1 [N],R1 [N]"]
)
@pytest.mark.parametrize("delimiter", [",", ";", "\t", "|"])
def test_lines_of_facts_above_the_names_cost_no_foot(tmp_path, above, names, delimiter):
    columns = [c for foot in (LEFT, RIGHT) for c in [foot / (names.count(",") // 2 + 1)] * (names.count(",") // 2 + 1)]
    rows = "\n".join(",".join(f"{v:.2f}" for v in row) for row in zip(*columns, strict=True))
    above = above.replace("|", "\n")
    (tmp_path / "walk.csv").write_text(f"{above}\n{names}\n{rows}\n".replace(",", delimiter))
    recording = read_recording(tmp_path / "walk.csv", options=ReadOptions(unit="N"))
    assert recording.rate_hz == 100.0
    assert recording.feet["left"].vertical_force == pytest.approx(LEFT, abs=0.011)
    assert recording.feet["right"].vertical_force == pytest.approx(RIGHT, abs=0.011)


@pytest.mark.parametrize("names", ["left (N),right (N),total (N)", "left Fz (N),right Fz (N),sum Fz (N)"])
def test_the_sum_of_two_feet_beside_them_is_no_plate(tmp_path, names):
    path = tmp_path / "walk.csv"
    path.write_text(f"Time (s),{names}\n" + rows([TIME, LEFT, RIGHT, LEFT + RIGHT], ","))
    check(analyse(path))


@pytest.mark.parametrize(
    ("unit", "factor"), [("%BW", 100.0 / WEIGHT), ("BW", 1.0 / WEIGHT), ("N/kg", 9.80665 / WEIGHT)]
)
def test_forces_relative_to_body_weight(tmp_path, unit, factor):
    from plantar.gait.analysis.subject import Subject

    path = tmp_path / "walk.csv"
    path.write_text(
        f"Time (s),Left GRF ({unit}),Right GRF ({unit})\n" + rows([TIME, LEFT * factor, RIGHT * factor], ",")
    )
    relative = analyse(path)
    assert relative.recording.raw
    assert float(relative.steps["peak_force_raw"].max()) == pytest.approx(100.0 * 800.0 / WEIGHT, rel=0.01)
    check(analyse(path, subject=Subject(mass_kg=WEIGHT / 9.80665)))


def mot() -> str:
    """OpenSim: x ahead, y up, z to the right."""
    names = [f"{p}ground_force_{c}" for p in ("", "1_") for c in ("vx", "vy", "vz", "px", "py", "pz")]
    columns = [TIME]
    for side, force, z in (("right", RIGHT, 0.1), ("left", LEFT, -0.1)):
        columns += [AHEAD[side], force, -LEFTWARD[side], PLACE[side], NONE, NONE + z]
    head = f"walk.mot\nversion=1\nnRows={len(TIME)}\nnColumns={len(columns)}\ninDegrees=yes\nendheader\n"
    return head + "\t".join(["time", *names]) + "\n" + rows(columns)


def forces() -> str:
    """Cortex: z up, places in mm, no times."""
    columns = [np.arange(1.0, len(TIME) + 1.0)]
    for side, force, y in (("right", RIGHT, 200.0), ("left", LEFT, 500.0)):
        columns += [AHEAD[side], LEFTWARD[side], force, 1e3 * PLACE[side], NONE + y, NONE, NONE]
    names = "\t".join(f"{c}{i}" for i in (1, 2) for c in ("FX", "FY", "FZ", "X", "Y", "Z", "MZ"))
    return f"[Force Data]\nNumberOfForcePlates=2\nSampleRate=100.000\n#Sample\t{names}\n" + rows(columns)


def vicon() -> str:
    """Vicon Nexus: a rate without a name, devices in groups, and units below the names."""
    columns = [v for side, force in (("left", LEFT), ("right", RIGHT)) for v in (AHEAD[side], LEFTWARD[side], force)]
    groups = ",,,".join(f"Imported AMTI OR6 Series Force Plate #{i} - Force" for i in (1, 2))
    head = f"Devices\n100\n,,{groups},,\nFrame,Sub Frame,Fx,Fy,Fz,Fx,Fy,Fz\n,,N,N,N,N,N,N\n"
    return head + rows([np.arange(1.0, len(TIME) + 1.0), NONE, *columns], ",")


def with_empty_names() -> str:
    """A column for a task, one for markers that is empty in most rows, and values that were not measured."""
    walk = [f"walk,{t:.2f},{a:.1f},{b:.1f},NaN,NaN," for t, a, b in WALK]
    walk[300] += "patient turns"
    return "Task,Time (s),Left Fz (N),Right Fz (N),Left COPx (m),Right COPx (m),Marker\n" + "\n".join(walk)


def parts_and_totals() -> str:
    columns = [part * force for force in (LEFT, RIGHT) for part in (0.4, 0.6, 1.0)]
    return "time,L heel [N],L toes [N],L [N],R heel [N],R toes [N],R [N]\n" + rows([TIME, *columns], ",")


def loadsol() -> str:
    parts = [part * force for force in (LEFT, RIGHT) for part in (0.4, 0.3, 0.3, 1.0)]
    names = "Time[secs]\theel-Force[N]\tmedial-Force[N]\tlateral-Force[N]\tForce[N]"
    head = "loadsol 1.7\t12.03.2020\nleft\t\t\t\t\tright\t\t\t\t\n"
    return head + f"{names}\t{names}\n" + rows([TIME, *parts[:4], TIME, *parts[4:]])


def gaitpdb() -> str:
    """PhysioNet: time, eight sensors of each foot, and the two sums; no names."""
    shares = (0.3, 0.2, 0.1, 0.05, 0.05, 0.1, 0.1, 0.1)
    return rows([TIME, *(k * LEFT for k in shares), *(k * RIGHT for k in shares), LEFT, RIGHT])


def d_flow() -> str:
    """A treadmill whose vertical is y, with markers and angles beside it."""
    names = [f"FP{i}.{c}{a}" for i in (1, 2) for c in ("Cop", "For") for a in "XYZ"]
    columns = [TIME]
    for side, force, x in (("left", LEFT, -0.1), ("right", RIGHT, 0.1)):
        columns += [NONE + x, NONE, PLACE[side], -LEFTWARD[side], force, -AHEAD[side]]
    return "\t".join(["TimeStamp", *names, "LHEE.PosX", "KneeAngle1"]) + "\n" + rows([*columns, 3e3 + TIME, TIME])


def bioware() -> str:
    """One Kistler plate: names and units in two rows."""
    head = "BioWare\nfile\t1\nabs time (s)\tFx\tFy\tFz\tAx\tAy\ns\tN\tN\tN\tm\tm\n"
    return head + rows([TIME, AHEAD["right"], LEFTWARD["right"], -RIGHT, PLACE["right"], NONE])


def visual3d() -> str:
    """Visual3D: rows of file, signal, kind and folder above the axes; frames are counted."""
    columns = [np.arange(1.0, len(TIME) + 1.0)]
    for side, force, y in (("left", LEFT, 0.1), ("right", RIGHT, -0.1)):
        columns += [AHEAD[side], LEFTWARD[side], force, PLACE[side], NONE + y, NONE]
    heads = [["walk.c3d"] * 12, ["FP1"] * 6 + ["FP2"] * 6, (["FORCE"] * 3 + ["COFP"] * 3) * 2, ["ORIGINAL"] * 12]
    lines = ["\t".join(["", *row]) for row in heads]
    return "\n".join([*lines, "\t".join(["ITEM", *"XYZXYZXYZXYZ"])]) + "\n" + rows(columns)


@pytest.mark.parametrize(
    ("name", "text", "kind", "sides"),
    [
        ("walk.mot", mot, "plate", ("left", "right")),
        ("walk.sto", mot, "plate", ("left", "right")),
        ("walk.forces", forces, "plate", ("left", "right")),
        ("loadsol.txt", loadsol, "insole", ("left", "right")),
        ("GaCo01_01.txt", gaitpdb, "insole", ("left", "right")),
        ("d_flow.txt", d_flow, "plate", ("left", "right")),
        ("bioware.txt", bioware, "plate", ("right",)),
        ("visual3d.txt", visual3d, "plate", ("left", "right")),
        ("vicon.csv", vicon, "plate", ("left", "right")),
        ("markers.csv", with_empty_names, "plate", ("left", "right")),
        ("regions.csv", parts_and_totals, "insole", ("left", "right")),
    ],
)
def test_text_of_laboratories(tmp_path, name, text, kind, sides):
    path = tmp_path / name
    path.write_text(text())
    walk = analyse(path)
    check(walk, sides)
    assert walk.recording.kind == kind


@pytest.mark.parametrize(
    ("mark", "point", "digits"),
    [(".", ",", 0), (".", ",", 2), (" ", ",", 0), (" ", ",", 2), ("'", ".", 2), (",", ".", 2)],
)
def test_marks_between_thousands(tmp_path, mark, point, digits):
    lines = [f"{t:.2f};{2.0 * a:,.{digits}f};{2.0 * b:,.{digits}f}" for t, a, b in WALK]
    lines = [line.translate(str.maketrans({",": mark, ".": point})) for line in lines]
    (tmp_path / "walk.csv").write_text("Time (s);Left Fz (N);Right Fz (N)\n" + "\n".join(lines))
    check(analyse(tmp_path / "walk.csv"), weight=1600.0)


def test_sensors_by_place_and_times_in_milliseconds(tmp_path):
    path = tmp_path / "fsr.csv"
    shares = {"heel": 0.3, "mid": 0.1, "met1": 0.2, "met5": 0.2, "toe": 0.2}
    path.write_text("millis," + ",".join(shares) + "\n" + rows([1e3 * TIME, *(k * LEFT for k in shares.values())], ","))
    walk = analyse(path)
    assert walk.recording.feet["left"].force.shape[1] == 5
    assert walk.recording.rate_hz == pytest.approx(100.0)
    assert np.median(walk.steps["contact_time_s"]) == pytest.approx(PERIOD * STANCE, abs=0.012)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("time,hip_flexion_r,knee_angle_r\n" + rows([TIME] * 3, ","), "no column of the table is a load"),
        ("time,LHEE_x,LHEE_y,LHEE_z\n" + rows([TIME] * 4, ","), "no column of the table is a load"),
        (
            "SUBJECT_ID,TRIAL_ID," + ",".join(f"F_V_PRO_{i}" for i in range(101)) + "\n" + rows([TIME[:20]] * 103, ","),
            "each row is a curve of a trial",
        ),
        ("time,Fx,Fy,Fz\n" + rows([TIME, RIGHT, RIGHT, RIGHT], ","), "no foot pushes so"),
        (
            "time,left (N),right (N)\n" + rows([TIME, LEFT, RIGHT], ",").replace(".", ","),
            "twice as many cells as names",
        ),
        ("time,Left Fz (N),Right Fz (lbf)\n" + rows([TIME, LEFT, RIGHT], ","), "different units: N, lbf"),
        ("time,Left force (V),Right force (V)\n" + rows([TIME, LEFT, RIGHT], ","), "unknown unit of force 'V'"),
        (
            ",".join(["time", *(f"left {i} (N)" for i in range(12))])
            + "".join(f"\n23:59:55:{i:02d}" + 12 * ",7" for i in range(30)),
            "no times that increase",
        ),
        (
            "time,left GRF AP,right GRF AP\n" + rows([TIME, AHEAD["left"], AHEAD["right"]], ","),
            "no column is a vertical force",
        ),
        ("time,Left Fz,Right Fz\ns,mV,mV\n" + rows([TIME, LEFT, RIGHT], ","), "unknown unit of force 'mV'"),
        ("Czas (s),F lewa (N),F prawa (N)\n" + rows([TIME, LEFT, RIGHT], ","), "no column of the table is a load"),
        (rows([AHEAD["left"], LEFT, 90.0 * AHEAD["left"], NONE], ","), "the columns have no names"),
        (
            "time,P1,P2,P3\n" + rows([TIME, AHEAD["left"], LEFT, 90.0 * AHEAD["left"]], ","),
            "as forces and moments of a plate do",
        ),
        (
            "stride,left_force_N,right_force_N\n" + rows([np.arange(20.0), 20.0 + TIME[:20], 20.0 + TIME[:20]], ","),
            "each row is a stride",
        ),
        ("time,Fz1_V,Fz2_V\n" + rows([TIME, LEFT, RIGHT], ","), "unknown unit of force 'V'"),
        ("a,b\n1,2\n", "not a recording|no recording over time"),
        ("left (N),right (N)\n1,2\n3,4\n", "2 row.s. of numbers, which is no recording over time"),
        ("time (s),left (N),right (N)\n" + rows([128.0 * TIME, LEFT, RIGHT], ","), "1.28 s apart, as steps are"),
        ("time,LTOE[0],LTOE[1],LTOE[2]\n" + rows([TIME] * 4, ","), 'no column .* --columns "time=time, left=COLUMN'),
        ("time,Fz1,Fz2\n" + rows([TIME, 0.01 * LEFT, 0.01 * RIGHT], ","), "no unit and reach 8"),
        ("time,Fz\n" + rows([TIME, 700.0 + 200.0 * np.sin(12.0 * TIME)], ","), "both feet walk on one plate"),
    ],
)
def test_what_is_no_walk_of_feet_is_refused(tmp_path, text, message):
    path = tmp_path / "table.csv"
    path.write_text(text)
    with pytest.raises(FormatError, match=message):
        analyse(path)


@pytest.mark.parametrize(
    ("head", "scale"),
    [
        ("ms,left 1 (N),left 2 (N),right 1 (N),right 2 (N)", 2000.0),
        ("time_L (s),left 1 (N),left 2 (N),right 1 (N),right 2 (N)", 2.0),
        ("time,left 1,left 2,right 1,right 2\nms,N,N,N,N", 2000.0),
        *(
            (f"{name},left 1 (N),left 2 (N),right 1 (N),right 2 (N)", 2.0)
            for name in (
                "Zeit (Sekunden)",
                "Temps (secondes)",
                "Elapsed",
                "Trial time (s)",
                "時間 [秒]",
                "Aika (s)",
                "X_Value",
            )
        ),
    ],
)
def test_times_by_headings_that_name_a_unit_or_a_foot(tmp_path, head, scale):
    """At 50 Hz, so that an assumed rate would show."""
    path = tmp_path / "walk.csv"
    rows = [f"{scale * t:g},{0.4 * a:.1f},{0.6 * a:.1f},{0.4 * b:.1f},{0.6 * b:.1f}" for t, a, b in WALK]
    path.write_text(head + "\n" + "\n".join(rows) + "\n")
    found = analyse(path)
    assert found.metrics["rate_hz"] == pytest.approx(50.0)
    assert found.metrics["feet"]["left"]["measures"]["peak_force_N"]["mean"] == pytest.approx(800.0, rel=0.01)


def test_times_of_day_below_another_heading(tmp_path):
    path = tmp_path / "walk.csv"
    lines = [f"12:00:{2.0 * t:06.3f},{a:.1f},{b:.1f}" for t, a, b in WALK]
    path.write_text("Datum/Zeit,left (N),right (N)\n" + "\n".join(lines) + "\n")
    assert analyse(path).metrics["rate_hz"] == pytest.approx(50.0)


def test_a_foot_without_a_sensor_has_no_double_support(tmp_path):
    path = tmp_path / "walk.csv"
    path.write_text("time (s),left (N),right (N)\n" + rows([TIME, LEFT, NONE + 3.0], ","))
    assert analyse(path).metrics["gait"]["double_support_percent"] is None


def test_one_step_on_each_of_two_plates_counts(tmp_path):
    """They have no stride, by which other steps are found to lie in the other foot's time."""
    one, other = (np.where((a <= TIME) & (b > TIME), f, 0.0) for a, b, f in ((0.8, 1.7, LEFT), (1.4, 2.1, RIGHT)))
    path = tmp_path / "plates.csv"
    path.write_text("time (s),FP1 Fz (N),FP2 Fz (N)\n" + rows([TIME, one, other], ","))
    walk = analyse(path, options=ReadOptions(plates=("left", "right")))
    assert [len(gait.used) for gait in walk.feet.values()] == [1, 1]
    assert walk.metrics["gait"]["implied_weight_N"] == pytest.approx(800.0 / 1.1, rel=0.01)


def test_a_column_that_is_there_twice_counts_once(tmp_path):
    path = tmp_path / "walk.csv"
    rows = [f"{t:g},{a:.1f},{a:.1f},{b:.1f}" for t, a, b in WALK]
    path.write_text("time (s),left (N),left (N),right (N)\n" + "\n".join(rows) + "\n")
    found = analyse(path)
    assert found.metrics["feet"]["left"]["measures"]["peak_force_N"]["mean"] == pytest.approx(800.0, rel=0.01)
    assert any("twice" in line for line in found.warnings)


@pytest.mark.parametrize(
    ("names", "columns"),
    [
        ("Left Fz (N),Left Fz (N),Right Fz (N)", (LEFT, 0.5 * LEFT, RIGHT)),
        ("Left Fz (N),left_fz [N],Right Fz (N)", (LEFT, 0.5 * LEFT, RIGHT)),
        ("left 1 [N],left 2 [N],L_2 [N],right 1 [N]", (0.3 * LEFT, 0.7 * LEFT, 0.2 * LEFT, RIGHT)),
        ("heel,heel,toe", (0.3 * LEFT, 0.7 * LEFT, 0.2 * LEFT)),
        ("Fx,Fy,Fz,Fx,Fy,Fz", (NONE, NONE, LEFT, NONE, NONE, RIGHT)),
    ],
)
def test_one_name_of_different_loads_is_refused(tmp_path, names, columns):
    path = tmp_path / "walk.csv"
    path.write_text(f"time (s),{names}\n" + rows([TIME, *columns], ","))
    with pytest.raises(FormatError, match=r"columns \d and \d have one name, .* allowed: a name for each"):
        analyse(path)


def test_cells_whose_numbers_begin_again_are_two_feet(tmp_path):
    path = tmp_path / "walk.csv"
    numbers = ",".join(str(i) for i in (*range(1, 9), *range(1, 9)))
    path.write_text(f"time (s),{numbers}\n" + rows([TIME, *[LEFT / 8.0] * 8, *[RIGHT / 8.0] * 8], ","))
    walk = analyse(path, options=ReadOptions(unit="N"))
    check(walk)
    assert any("names begin again" in line for line in walk.warnings)


@pytest.mark.parametrize("maker", ["GAITRite", "zebris"])
def test_exports_without_a_public_description_are_refused_by_name(tmp_path, maker):
    path = tmp_path / "walk.csv"
    path.write_text(f"{maker} export\ntime (s),Left (N),Right (N)\n" + rows([TIME, LEFT, RIGHT], ","))
    with pytest.raises(FormatError, match=rf"an export of {maker}, whose format has no public description"):
        analyse(path)
    check(analyse(path, format="csv"))


@pytest.mark.parametrize("names", ["Left Fz (N),Right Fz (N)", "FP1_Fz,FP2_Fz"])
@pytest.mark.parametrize("mark", [-999.0, 9999.0])
def test_a_mark_among_forces_counts_as_not_measured(tmp_path, names, mark):
    path, rng = tmp_path / "walk.csv", np.random.default_rng(5)
    columns = [force + rng.normal(0.0, 1.0, len(TIME)) for force in (LEFT, RIGHT)]
    path.write_text(f"time (s),{names}\n" + rows([TIME, *columns], ","))
    whole = analyse(path).steps["impulse_Ns"]
    for force in columns:
        force[rng.choice(len(TIME), 20, replace=False)] = mark
    path.write_text(f"time (s),{names}\n" + rows([TIME, *columns], ","))
    found = analyse(path)
    assert found.steps["impulse_Ns"] == pytest.approx(whole, rel=0.01)
    assert f"40 value(s) are {mark:g}, far from all others: taken as marks for what was not measured" in found.warnings


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16-le", "utf-16-be"])
def test_a_table_that_is_marked_twice_keeps_its_clock(tmp_path, encoding):
    path = tmp_path / "walk.csv"
    text = "\ufeff\ufefftime (s),Left Fz (N),Right Fz (N)\n" + rows([0.8 * TIME, LEFT, RIGHT], ",")
    path.write_bytes(text.encode(encoding))
    assert analyse(path).recording.rate_hz == pytest.approx(125.0)


def trials(begins: Sequence[float]) -> tuple[np.ndarray, np.ndarray]:
    """Force (n,) of a foot that steps on a plate at some times, and how far each contact has gone."""
    share = np.sum([np.where((t < TIME) & (t + 0.7 > TIME), (TIME - t) / 0.7, 0.0) for t in begins], axis=0)
    return 800.0 * np.sin(np.pi * share), share


def test_a_noisy_belt_that_is_empty_before_and_after_the_walk(tmp_path):
    path, rng = tmp_path / "walk.csv", np.random.default_rng(1)
    walk = [LEFT * ((TIME > 2.9) & (TIME < 6.2)), RIGHT * ((TIME > 3.4) & (TIME < 6.7))]
    for _ in range(4):
        columns = [force + rng.normal(0.0, 11.0, len(TIME)) for force in walk]
        path.write_text("time (s),Left Fz (N),Right Fz (N)\n" + rows([TIME, *columns], ","))
        assert [len(gait.steps) for gait in analyse(path).feet.values()] == [3, 3]


@pytest.mark.parametrize("names", ["Left Fz (N),Right Fz (N)", "left (N),right (N)", "FP1_Fz,FP2_Fz"])
def test_no_stride_leads_from_one_trial_to_the_next(tmp_path, names):
    path = tmp_path / "walk.csv"
    columns = [trials(begins)[0] for begins in ((0.5, 3.2, 5.9), (1.05, 3.75, 6.45))]
    path.write_text(f"time (s),{names}\n" + rows([TIME, *columns], ","))
    found = analyse(path)
    assert {side: len(gait.steps) for side, gait in found.feet.items()} == {"left": 3, "right": 3}
    assert np.isnan([found.steps["stride_time_s"], found.steps["stance_percent"]]).all()
    assert np.nanmax(found.steps["step_time_s"], initial=0.0) < 0.6


@pytest.mark.parametrize("across", [False, True])
def test_excursions_on_a_plate_are_along_the_walk(tmp_path, across):
    """Whatever axis of the laboratory people walk along."""
    path = tmp_path / "walk.csv"
    force, gone = trials((0.5, 3.2, 5.9))
    ahead, left = (0.2 * force * (gone - 0.5), 0.1 + 0.2 * gone), (-0.04 * force, 0.3 + 0.02 * np.sin(np.pi * gone))
    (fx, x), (fy, y) = (left, ahead) if across else (ahead, left)
    path.write_text(
        "time (s),FP1_Fx,FP1_Fy,FP1_Fz,FP1_COPx (m),FP1_COPy (m)\n" + rows([TIME, fx, fy, force, x, y], ",")
    )
    steps = analyse(path).steps
    assert steps["cop_excursion_ap_m"] == pytest.approx([0.19] * 3, abs=0.01)
    assert steps["cop_excursion_ml_m"] == pytest.approx([0.02] * 3, abs=0.005)


def test_people_who_walk_back_over_the_plates_keep_their_feet(tmp_path):
    """Left and right follow from the direction of each pass, not from that of all."""
    plates = [np.zeros((5, len(TIME))) for _ in range(2)]
    true = {"left": [0.5, 3.75, 5.9], "right": [1.05, 3.2, 6.45]}
    for side, begins in true.items():
        for k, begin in enumerate(begins):
            way = -1.0 if k == 1 else 1.0  # the second pass goes back, over the second plate first
            plate = (side == "right") if way > 0.0 else (begin == 3.2)
            force, gone = trials([begin])
            x = 0.7 * plate + (0.1 + 0.2 * gone if way > 0.0 else 0.3 - 0.2 * gone)
            y = (0.06 if side == "left" else -0.06) * way
            inward = (-0.04 if side == "left" else 0.04) * way
            on = force > 0.0
            plates[plate] += np.array([way * 0.2 * force * (gone - 0.5), inward * force, force, x * on, y * on])
    names = [f"FP{i}_{name}" for i in (1, 2) for name in ("Fx (N)", "Fy (N)", "Fz (N)", "COPx (m)", "COPy (m)")]
    path = tmp_path / "walk.csv"
    path.write_text(f"time (s),{','.join(names)}\n" + rows([TIME, *plates[0], *plates[1]], ","))
    found = analyse(path)
    for side, begins in true.items():
        assert [s.heel_strike_s for s in found.feet[side].steps] == pytest.approx(begins, abs=0.02)


@pytest.mark.parametrize("rate", [100.0, 300.0, 500.0, 1000.0])
def test_a_rate_that_is_wrong_ends_in_a_report(tmp_path, rate):
    """Contacts that are cut off and too long for steps are no spans of standing."""
    path = tmp_path / "walk.csv"
    path.write_text("Left Fz (N),Right Fz (N)\n" + rows([LEFT, RIGHT], ","))
    segments = analyse(path, options=ReadOptions(rate_hz=rate)).metrics["segments"]
    assert all(0.0 <= s["begin_s"] < s["end_s"] <= len(TIME) / rate for s in segments)


CLOCKS = [  # names, what they hold (time and load of the left and the right foot), times of one second
    ("time L [s],left 1 [N],time R [s],right 1 [N]", "TLtl", 1.0),
    ("Left time (s),Left Fz (N),Right time (s),Right Fz (N)", "TLtl", 1.0),
    ("t_L,L1 [N],t_R,R1 [N]", "TLtl", 1.0),
    ("time_R_ms,R1 [N],time_L_ms,L1 [N]", "tlTL", 1e3),
    ("left_time [ms],right_time [ms],left (N),right (N)", "TtLl", 1e3),
    ("time [s],left 1 [N],time [s],right 1 [N]", "TLtl", 1.0),
    ("time L [s],cell 1 [N],time R [s],cell 1 [N]", "TLtl", 1.0),
]


@pytest.mark.parametrize(("names", "held", "scale"), CLOCKS)
@pytest.mark.parametrize(("shift", "drift"), [(0.0, 1.0), (0.2, 1.0), (0.013, 1.0), (0.0, 1.02), (-0.1, 0.99)])
def test_each_foot_has_its_own_clock(tmp_path, names, held, scale, shift, drift):
    """Times of the right foot are shifted and drift: its force is found where it was measured."""
    late = TIME * drift + shift
    columns = {
        "T": scale * TIME,
        "t": scale * late,
        "L": 400.0 + 100.0 * np.sin(TIME),
        "l": 400.0 + 100.0 * np.sin(late),
    }
    columns = [columns[sign] for sign in held]
    (tmp_path / "walk.csv").write_text(names + "\n" + rows(columns, ","))
    recording = read_recording(tmp_path / "walk.csv")
    for foot in recording.feet.values():
        known = np.isfinite(foot.vertical_force)
        assert known.mean() > 0.9
        assert foot.vertical_force[known] == pytest.approx(400.0 + 100.0 * np.sin(recording.time[known]), abs=0.05)
    assert any("interpolated" in w for w in recording.warnings) == ((shift, drift) != (0.0, 1.0))
    assert (len(recording.time) == len(TIME)) or shift or drift != 1.0


def test_a_clock_that_holds_no_times_is_refused(tmp_path):
    path = tmp_path / "walk.csv"
    text = "".join(f"{0.01 * i:g},{i},12:00:{0.01 * i:05.2f},{i}\n" for i in range(200))
    path.write_text("time L [s],left 1 [N],time R [s],right 1 [N]\n" + text)
    with pytest.raises(FormatError):
        read_recording(path)


def test_temperatures_of_the_feet_are_no_times(tmp_path):
    path = tmp_path / "walk.csv"
    path.write_text("time [s],left 1 [N],right 1 [N],T_L,T_R\n" + rows([TIME, LEFT, RIGHT, NONE, 30.0 + NONE], ","))
    told = " ".join(read_recording(path).warnings)
    assert "interpolated" not in told
    assert "'T_L' is no cell" in told


def test_a_number_that_cells_leave_out_is_reported(tmp_path):
    path = tmp_path / "walk.csv"
    path.write_text(
        "time (s),left 1 [N],left 2 [N],zone [N],left 4 [N],left 5 [N]\n" + rows([TIME, *[LEFT / 5.0] * 5], ",")
    )
    (told,) = [w for w in analyse(path).warnings if "without" in w]
    assert told.startswith("the left foot has cells 1 to 5 without 3: forces are about 20 % too small")


@pytest.mark.parametrize("lacking", range(4))
def test_a_component_that_a_plate_lacks_exchanges_no_feet(tmp_path, lacking):
    """The direction of walking does not follow from one horizontal force alone."""
    path = tmp_path / "walk.csv"
    names = ["FP1_Fx", "FP1_Fy", "FP2_Fx", "FP2_Fy", "FP1_Fz", "FP1_COPx", "FP1_COPy", "FP2_Fz", "FP2_COPx", "FP2_COPy"]
    one = [AHEAD["left"], LEFTWARD["left"]], [LEFT, PLACE["left"], NONE + 0.1]
    other = [AHEAD["right"], LEFTWARD["right"]], [RIGHT, PLACE["right"], NONE - 0.1]
    columns = [*one[0], *other[0], *one[1], *other[1]]
    del names[lacking], columns[lacking]
    path.write_text("time (s)," + ",".join(names) + "\n" + rows([TIME, *columns], ","))
    check(analyse(path))
