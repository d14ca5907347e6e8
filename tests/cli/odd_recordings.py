"""Short recordings of every magnitude and shape, and the verbs to run on them; determined by the seed."""
import math
import random


def number(value: float) -> str:
    return repr(value)


class OddRecording:
    """A table of 2 to 200 samples: plausible, degenerate or absurd."""

    def __init__(self, seed: int):
        self.random = random.Random(seed)
        draw = self.random
        self.samples = draw.choice([2, 3, 4, 5, 8, 10, 11, 16, 20, 33, 50, 100, 200, 200, 200, draw.randint(2, 200), draw.randint(100, 200)])
        self.rate_hz = draw.choice([100.0, 10.0, 1000.0, 20000.0, 10.0 ** draw.uniform(-3, 5)])
        self.scale = draw.choice([1.0] * 8 + [1e-9, 1e9, 1e17, 1e150, 10.0 ** draw.uniform(-12, 18)])
        self.unit = draw.choice(["m/s^2", "m/s^2", "g", "mg", ""])
        self.gyro = draw.random() < 0.3
        self.timed = draw.random() < 0.8

    def stamps(self) -> list:
        draw, step = self.random, 1.0 / self.rate_hz
        kind = draw.choice(["even", "even", "even", "jitter", "gap", "repeated", "back", "huge"])
        at = [k * step for k in range(self.samples)]
        middle = self.samples // 2
        if kind == "jitter":
            at = [t + draw.uniform(0, 0.4) * step for t in at]
        if kind == "gap":
            at = at[:middle] + [t + 1000 * step for t in at[middle:]]
        if kind == "repeated":
            at[middle:middle + 2] = [at[middle]] * len(at[middle:middle + 2])
        if kind == "back":
            at = at[:middle] + [t - 2.5 * step for t in at[middle:]]
        if kind == "huge":
            at = [t + 1.7e9 for t in at]
        return at

    def axes(self) -> list:
        """Three axes of acceleration, with one of the shapes that verbs detect."""
        draw, g = self.random, 9.80665
        kind = draw.choice(["rest", "rest", "turning", "turning", "noise", "constant", "zero", "steps", "ramp"])
        noise = draw.choice([0.0, 1e-6, 0.01, 0.01, 1.0])
        omega, out = draw.uniform(0.1, 30.0), []
        for k in range(self.samples):
            t = k / self.rate_hz
            row = {"rest": [0.1, -0.2, g],
                   "turning": [g * math.sin(omega * t), g * math.cos(omega * t), 0.05],
                   "noise": [draw.gauss(0, 1) for _ in range(3)],
                   "constant": [1.0, 2.0, 3.0],
                   "zero": [0.0, 0.0, 0.0],
                   "steps": [[g, 0, 0], [0, g, 0], [0, 0, g], [-g, 0, 0], [0, -g, 0], [0, 0, -g]][6 * k // self.samples],
                   "ramp": [0.01 * k, 0.0, g]}[kind]
            out.append([(value + draw.gauss(0, noise)) * self.scale for value in row])
        return out

    def text(self) -> str:
        draw = self.random
        rows = self.axes()
        if draw.random() < 0.2:
            bad = draw.choice([math.nan, math.inf, -math.inf, 3.4e38, 1e300, 5e-324, -0.0])
            for _ in range(draw.choice([1, 2, self.samples])):
                draw.choice(rows)[draw.randrange(3)] = bad
        if self.gyro:
            rows = [row + [draw.gauss(0, 1) for _ in range(3)] for row in rows]
        unit = f" ({self.unit})" if self.unit else ""
        heading = [f"a{axis}{unit}" for axis in "xyz"] + ([f"g{axis} (rad/s)" for axis in "xyz"] if self.gyro else [])
        if self.timed:
            heading = ["t (s)"] + heading
            rows = [[t] + row for t, row in zip(self.stamps(), rows)]
        return ",".join(heading) + "\n" + "".join(",".join(map(number, row)) + "\n" for row in rows)

    def command(self, name: str) -> tuple:
        """A verb with sensible and senseless flags, on the recording of that name: (verb, arguments)."""
        draw = self.random
        verb = draw.choice(["inspect", "convert", "noise", "drift", "calibrate", "tumble", "tilt", "track", "wheel", "tune"])
        flags = [] if self.timed else draw.choice([[], ["--rate", "100"], ["--rate", "1e-3"]])
        flags += draw.choice([[], [], [], ["--from", "0.01"], ["--to", number(0.5 * self.samples / self.rate_hz)]])
        flags += {} if self.unit else draw.choice([[], ["--unit", "m/s2"], ["--unit", "counts"]])
        flags += draw.choice({
            "inspect": [[]],
            "convert": [["-o", "out.csv"], ["-o", "out.npy"], ["-o", "out.mat"]],
            "noise": [[], ["--statistic", "totdev"], ["--data", "phase"], ["--confidence", "0.999999"],
                      ["--taus", "all"], ["--statistic", "hdev", "--taus", "decade"]],
            "drift": [[], ["--since-switch-on", "3600"], ["--since-switch-on", "1e6"], ["--forecast", "1e9"]],
            "calibrate": [[], ["--means"], ["--parameters", "6", "--monte-carlo", "20"], ["--six-position"],
                          ["--monte-carlo", "0", "--shortest-rest", "0.01"]],
            "tumble": [[], ["--angles", "0,90,180,270"], ["--rotating"], ["--shortest-rest", "0.01"]],
            "tilt": [[], ["--no-gyro"], ["--base", "moving"], ["--base", "still"]],
            "track": [[], ["--axis", "x"], ["--gravity", "removed"], ["--same-place"], ["--model", "pva", "--axis", "x"],
                      ["--jerk-psd", "1e-9"], ["--as-acceleration"]],
            "wheel": [[], ["--radius", "0.1"], ["--spin-axis", "z"], ["--no-gyro"], ["--rim-radius", "0.3"]],
            "tune": [[], ["--model", "rest"], ["--model", "wheel"]],
        }[verb])
        return verb, [name, *flags]
