"""Smooth systematic errors of traces: what a laboratory and a model share of what neither knows.

A reading is off by a smooth random function of time that begins with its pulse: a Gaussian process (Kennedy
& O'Hagan, J. R. Stat. Soc. B 63, 425, 2001) whose standard deviation is a share of that reading's peak. Time
counts in widths of the pulse from its peak, so that one law holds for all runs of a gauge; it changes slowly
with the logarithm of speed. Gauges have laws of their own. It is drawn from the covariance itself, so that
what an ideal test sees beside it can be worked out (`Smooth.seen`).
"""

from dataclasses import dataclass

import numpy as np
import scipy

# It sets in between so many widths before the peak.
BEGINS, WHOLE = -1.5, -0.75
# Correlation length in the logarithm of speed: runs lie within a factor of 2.2 on either side of the middle.
SPEED_LENGTH = float(np.log(2.2))
# Variance added to the covariance so that it can be factorised, as a share of its own: noise of 1e-4 of it.
JITTER = 1e-8


@dataclass(frozen=True)
class Smooth:
    """A smooth systematic error of the readings of one record.

    Attributes:
        traces: (runs, gauges, samples) what gauges would read without it, N.
        speeds: (runs,) of the striker, m/s.
        size: standard deviation as a share of each reading's peak.
        length: correlation time in widths of the pulse at half height.
    """

    traces: np.ndarray
    speeds: np.ndarray
    size: float
    length: float

    def drawn(self, random: np.random.Generator) -> np.ndarray:
        """(runs, gauges, samples) one error, N."""
        runs, gauges, samples = self.traces.shape
        result = np.zeros(self.traces.shape)
        for gauge in range(gauges):
            # Outside its window the process is exactly zero, with a variance that only serves the factors.
            covariance, window = self.covariance(gauge)
            root = np.linalg.cholesky(covariance + JITTER * np.eye(runs * samples))
            own = window * (root @ random.standard_normal(runs * samples))
            result[:, gauge] = own.reshape(runs, samples)
        return result

    def covariance(self, gauge: int) -> tuple[np.ndarray, np.ndarray]:
        """Correlation (runs × samples, twice) of one gauge's error, and its standard deviation in N."""
        traces = self.traces[:, gauge]
        time = np.stack([_widths(trace) for trace in traces])
        speed = np.repeat(np.log(self.speeds) / SPEED_LENGTH, traces.shape[1])
        far = np.square(np.subtract.outer(time.ravel(), time.ravel()) / self.length)
        far += np.square(np.subtract.outer(speed, speed))
        share = np.clip((time - BEGINS) / (WHOLE - BEGINS), 0.0, 1.0)
        rises = share**2 * (3.0 - 2.0 * share)
        return np.exp(-0.5 * far), (self.size * traces.max(axis=1, keepdims=True) * rises).ravel()

    def seen(self, left: np.ndarray, slopes: np.ndarray, sigma: np.ndarray) -> float:
        """d′ of what is left of a change, to an ideal test that knows this error's covariance and size.

        Args:
            left: (data,) whitened difference that the record's errors leave.
            slopes: (data, errors) whitened change for one standard deviation of each.
            sigma: (gauges,) noise of a sample in N.
        """
        runs, gauges, samples = self.traces.shape
        columns = np.column_stack([left, slopes]).reshape(runs, gauges, samples, -1)
        products = np.zeros((columns.shape[-1],) * 2)
        for gauge in range(gauges):
            covariance, deviation = self.covariance(gauge)
            deviation = deviation / sigma[gauge]
            covariance *= np.outer(deviation, deviation)
            root = np.linalg.cholesky(covariance + np.eye(runs * samples))
            own = scipy.linalg.solve_triangular(
                root, columns[:, gauge].reshape(runs * samples, -1), lower=True
            )
            products += own.T @ own
        cross, square = products[0, 1:], products[1:, 1:] + np.eye(len(products) - 1)
        return float(np.sqrt(max(0.0, products[0, 0] - cross @ np.linalg.solve(square, cross))))


def _widths(trace: np.ndarray) -> np.ndarray:
    """(samples,) time from the peak of a trace, in widths at half its height."""
    peak = int(trace.argmax())
    low = np.flatnonzero(trace < 0.5 * trace[peak])
    first = low[low < peak].max(initial=-1)
    last = low[low > peak].min(initial=len(trace))
    return (np.arange(len(trace)) - peak) / max(2, last - first - 1)
