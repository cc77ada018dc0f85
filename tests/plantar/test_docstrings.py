"""Every public name of the perception says what it takes, gives and raises, and shows it."""

import importlib
import inspect
import pkgutil

import pytest

import plantar

from ..public_names import public_names

# Recordings, files and drawing are documented where they are tested; errors are one line each.
OTHERS = {"errors", "parts", "partial_contact", "plotting", "pressure_recording", "recorder", "recording"}
MODULES = sorted(m.name for m in pkgutil.iter_modules(plantar.__path__) if not m.ispkg and m.name not in OTHERS)


def public_values():
    for module in MODULES:
        loaded = importlib.import_module(f"plantar.{module}")
        for name in public_names(loaded):
            value = getattr(loaded, name)
            if inspect.isfunction(value) or inspect.isclass(value):
                yield pytest.param(value, id=f"{module}.{name}")


@pytest.mark.parametrize("value", list(public_values()))
def test_a_public_name_has_an_example(value):
    assert ">>>" in (value.__doc__ or "")


@pytest.mark.parametrize("value", [p for p in public_values() if inspect.isfunction(p.values[0])])
def test_a_public_function_names_arguments_results_and_errors(value):
    text = value.__doc__
    signature = inspect.signature(value)
    for name in signature.parameters:
        assert f"        {name}: " in text
    if signature.return_annotation not in ("None", None):
        assert "Returns:\n" in text or "Yields:\n" in text
    assert ("Raises:\n" in text) or "raise " not in inspect.getsource(value)


@pytest.mark.parametrize("value", [p for p in public_values() if inspect.isclass(p.values[0])])
def test_a_public_class_documents_its_members(value):
    for name, member in vars(value).items():
        function = member.fget if isinstance(member, property) else getattr(member, "func", member)
        function = getattr(function, "__func__", function)
        if not name.startswith("_") and inspect.isfunction(function):
            assert function.__doc__, name
