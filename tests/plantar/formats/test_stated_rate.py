"""A rate in any words: of frames a second or of the time of a frame, above a table or beside arrays."""

import numpy as np
import pytest

from plantar import FormatError
from plantar.formats import read_recording
from plantar.formats.given import recording_of
from plantar.formats.stated_rate import stated_rate

RATES = {
    "Sample rate: {} Hz": 1.0,
    "Sampling Rate (kHz): {}": 1e-3,
    "SampleRate={}": 1.0,
    "# rate: {} 1/s": 1.0,
    "Frequency: {} s^-1": 1.0,
    "sampling_rate_khz = {}": 1e-3,
    "Samples per second: {}": 1.0,
    "Samples/s: {}": 1.0,
    "Frame rate = {} fps": 1.0,
    "Fs: {}": 1.0,
    "Abtastfrequenz: {} Hz": 1.0,
    "Data rate: {} samples/s": 1.0,
    "Sample rate: {} per minute": 60.0,
    "{} Hz": 1.0,
    "Sampling rate {} kHz": 1e-3,
    "Sampling rate {}": 1.0,
    "Scan Rate\t{}": 1.0,
    "Points per second: {}": 1.0,
    "Fréquence d'échantillonnage : {} Hz": 1.0,
    "Bemonsteringsfrequentie: {} Hz": 1.0,
    "サンプリング周波数: {} Hz": 1.0,
    "Video Frame Rate: 25\nAnalog Rate: {}": 1.0,
}
PERIODS = {
    "Sample interval (ms): {}": 1e3,
    "Sample period: {} s": 1.0,
    "dt = {}": 1.0,
    "delta_t [µs] = {}": 1e6,
    "Sampling rate: {} ms": 1e3,
    "Seconds per frame: {}": 1.0,
    "Frame Time: {}": 1.0,
    "Time/picture: {} ms": 1e3,
    "Zeitschritt: {} ms": 1e3,
}
STATED = [(line, factor, 1.0) for line, factor in RATES.items()]
STATED += [(line, factor, -1.0) for line, factor in PERIODS.items()]
KEYS = [
    "sampling_rate",
    "sample_rate",
    "Fs",
    "FS",
    "sampling_frequency",
    "frame_rate",
    "fps",
    "hz",
    "freq",
    "samplerate",
]


@pytest.mark.parametrize(("line", "factor", "power"), STATED)
@pytest.mark.parametrize("rate", [50.0, 200.0, 1000.0])
def test_a_line_above_a_table(tmp_path, line, factor, power, rate):
    stated = line.format(f"{factor * rate**power:.8g}")
    (tmp_path / "walk.csv").write_text(f"{stated}\nleft 1 [N],left 2 [N],right 1 [N]\n" + "1,2,3\n" * 40)
    assert read_recording(tmp_path / "walk.csv").rate_hz == pytest.approx(rate)


@pytest.mark.parametrize("key", [*KEYS, "rate_hz", "rate", "fs", "frequency", "dt", "frame_interval_ms"])
@pytest.mark.parametrize("shape", [(), (1,), (1, 1)])
def test_an_array_of_one_number(tmp_path, key, shape):
    value = np.full(shape, {"dt": 0.005, "frame_interval_ms": 5.0}.get(key, 200))
    arrays = {"left": np.ones((30, 4)), "right": np.ones((30, 4)), "unit": "N", key: value}
    np.savez(tmp_path / "walk.npz", **arrays)
    assert recording_of(arrays).rate_hz == read_recording(tmp_path / "walk.npz").rate_hz == pytest.approx(200.0)


@pytest.mark.parametrize(
    "name", ["Heart rate", "Cut-off frequency", "Step frequency", "Loading rate", "Recording period"]
)
def test_another_rate_is_none_of_frames(name):
    assert stated_rate({name: "60 Hz"}, []) is None


@pytest.mark.parametrize(
    ("facts", "rate", "words"),
    [
        ({"dt": "5"}, 200.0, "taken as 5 ms"),
        ({"rate": "about 100 Hz", "sampling": "by hand"}, 100.0, "is not clear"),
        ({"rate": "100 frames a day"}, 100.0, "is not clear"),
        (
            {"analog rate": "1 kHz", "frame rate": "200"},
            1000.0,
            "several rates, analog rate 1000 Hz, frame rate 200 Hz",
        ),
    ],
)
def test_what_is_assumed_is_told(facts, rate, words):
    warnings: list[str] = []
    assert stated_rate(facts, warnings) == pytest.approx(rate)
    assert words in " ".join(warnings)
    assert len(warnings) == 1


@pytest.mark.parametrize("sign", "\t;")
def test_a_rate_stated_once_a_column_is_clear(sign):
    warnings: list[str] = []
    assert stated_rate({"Rate (Hz)": sign.join(["1000.000000"] * 8)}, warnings) == 1000.0
    assert not warnings
    stated_rate({"Rate (Hz)": sign.join(["1000", "500"])}, warnings)
    assert "is not clear" in warnings[0]


@pytest.mark.parametrize("text", ["fast", "inf", "1.2.3", "2024-05-01", "12:30"])
@pytest.mark.parametrize("name", ["rate", "dt"])
def test_what_is_no_number_is_refused(name, text):
    with pytest.raises(FormatError, match=rf"'{name}' is no number of frames a second .*--rate overrides"):
        stated_rate({name: text}, [])


@pytest.mark.parametrize(("text", "rate"), [("1,000 Hz", 1000.0), ("2.048", 2048.0), ("50.000 Hz", 50.0), ("2.5", 2.5)])
def test_thousands_are_no_few_frames_a_second(text, rate):
    warnings: list[str] = []
    assert stated_rate({"Sample rate": text}, warnings) == rate
    assert bool(warnings) == (rate >= 1000.0)
