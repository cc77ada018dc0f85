"""`plantar doctor`: list what is installed, missing or broken of what Plantar can use, and how to get it."""

from plantar.common.console.command import Command, Json, end_command


def doctor(as_json: Json = False) -> None:
    """List what is installed of what Plantar can use, what is missing or broken, and how to get it.

    Exit code 1 if a required library is missing, or an installed one cannot be loaded.

    Example: plantar doctor
    """
    from plantar import doctor as examination

    found = examination.examine()
    failures = ["a library is missing or broken: see above"] if not found["holds"] else []
    end_command(found, as_json, examination.doctor_text(found), failures, not found["holds"])


COMMAND = Command(doctor, "List what is installed, what is missing and how to get it.", 100)
