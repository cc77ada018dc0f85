"""Files for two workers and more: what costs most first, and a worker that dies costs one test.

xdist's own scheduler does not end well after a crash. It hands the dead worker's finished files out again as work of no
tests, and a worker that holds its last test until it hears of another then waits for ever. It runs the test again that
crashed, and when two workers die, it sends tests to the one that has not collected them yet.
"""

from xdist.scheduler import LoadFileScheduling
from xdist.workermanage import WorkerController

__all__ = ["FilesAtOnce"]

TOGETHER = (
    "tests/shoes/checks/",
    "tests/shoes/papers/",
    "tests/shoes/solid/test_kernel.py",
    "tests/shoes/solid/test_step_model.py",
    "tests/shoes/test_build.py",
    "tests/shoes/test_coupon.py",
)
"""Folders and files whose tests look at one pair of shoes, which takes 20 s of the processor to build and export."""


class FilesAtOnce(LoadFileScheduling):
    """A file at a time to each worker; what a dead one has left goes to the others, without the test it died of."""

    def _split_scope(self, nodeid: str) -> str:
        """The file of a test, or one name for all files that share something slow, which one worker makes once."""
        return "one pair of shoes" if nodeid.startswith(TOGETHER) else super()._split_scope(nodeid)

    def remove_node(self, node: WorkerController) -> str | None:
        """Take a worker away, and give the name of the test that it died of, if it had any left."""
        for unit in [name for name, tests in self.assigned_work[node].items() if all(tests.values())]:
            del self.assigned_work[node][unit]
        left = self.assigned_work.pop(node)
        crashed = next((test for tests in left.values() for test, done in tests.items() if not done), None)
        for name, tests in left.items():
            rest = {test: done or test == crashed for test, done in tests.items()}
            if not all(rest.values()):
                self.workqueue[name] = rest
        for other in self.nodes:
            self._reschedule(other)
        return crashed

    def _reschedule(self, node: WorkerController) -> None:
        """Give files until more than two tests wait: a worker begins its last test when it knows of another."""
        while node in self.registered_collections and not node.shutting_down:
            if not self.workqueue:
                node.shutdown()
            elif self._pending_of(self.assigned_work[node]) > 2:
                return
            else:
                self._assign_work_unit(node)
