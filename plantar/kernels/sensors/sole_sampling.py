"""A sole's skin as its electronics deliver it, in one call a sample: forces, distances, and the reading of both."""

__all__ = ["ProximitySampling", "SoleSampling"]


class ProximitySampling:
    """Samples the distances of n taxels, or leaves them out.

    `noise`: `NoiseRows` in m, n a sample, which advances at each sample, with or without rays; `dead`: indices of dead
    taxels. Attributes `cast` and `skipped`: how many rays were cast, or left out since no caller wanted them.
    """

    def __init__(self, noise, count, dead):
        self.noise = noise
        self.count = count
        self.dead = dead
        self.cast = 0
        self.skipped = 0

    def skip(self):
        """A sample without a measurement."""
        self.noise.advance()
        self.skipped += self.count

    def leave(self):
        """A sample of rays that were cast for comparison alone."""
        self.noise.advance()
        self.cast += self.count

    def of(self, rays):
        """Readings (n,) in m of `SoleRays` that were cast: inf out of range, NaN if dead."""
        row = self.noise.advance()
        self.cast += self.count
        return rays.tell(self.noise, row, self.dead)


class SoleSampling:
    """Samples a sole of springs under its contacts.

    Args:
        clock: `SampleClock` of when samples are due.
        sample: `TaxelSample`.
        sole: `PressedSole`.
        seen: `ContactsInSole`, which looks from the sole's frame.
        reach: Largest gap in m of contact without load.
        proximity: `ProximitySampling`, or None.
        queue: Readings (deque) on their way, the oldest of which is delivered; at least one.
        kind: Their class, `plantar.Reading`.
    """

    def __init__(self, clock, sample, sole, seen, reach, proximity, queue, kind):
        self.clock = clock
        self.sample = sample
        self.sole = sole
        self.seen = seen
        self.reach = reach
        self.proximity = proximity
        self.queue = queue
        self.kind = kind

    def read(self, now, contacts, rays):
        """The reading that is delivered `now`, in s, after a sample if one is due.

        `contacts`: `FootContacts` of the sole; `rays`: its `SoleRays`, None where no caller wants distances.
        """
        if self.clock.due(now):
            distance = None
            if self.proximity is not None:
                if rays is None:
                    self.proximity.skip()
                else:
                    rays.look()
                    distance = self.proximity.of(rays)
            force = self.sample.of_contacts(self.sole, contacts, self.seen, self.reach)
            reading = self.kind.__new__(self.kind)
            reading._take_over(now, force, distance)
            self.queue.append(reading)
        return self.queue[0]
