"""Physics steps of a walk, one after another, each with its set-points and judge."""

__all__ = ["PhysicsSteps"]


class PhysicsSteps:
    """Makes physics steps of a walk on drives as modelled, without pushes.

    Attribute `seen`: what `StepWatch.step` reported after the last step.

    Args:
        drives: `Setpoints` of the legs' servos, as they are at each step.
        step: Makes one physics step.
        contacts: `FeetReader` of both soles.
        watch: `StepWatch` that follows them.
        pieces: `PieceLoads` of the ground, or None.
    """

    def __init__(self, drives, step, contacts, watch, pieces):
        self.drives = drives
        self.step = step
        self.contacts = contacts
        self.watch = watch
        self.pieces = pieces
        self.seen = 0

    def advance(self, steps):
        """Make so many steps, or as many as it takes until the judge sees something; returns how many."""
        done = 0
        self.seen = 0
        while done < steps and self.seen == 0:
            self.drives.drive()
            self.step()
            done += 1
            feet = self.contacts.read()
            self.seen = self.watch.step(feet, self.contacts.count)
            if self.pieces is not None:
                self.pieces.step(feet)
        return done
