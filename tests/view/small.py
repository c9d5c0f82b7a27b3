"""The hand-made device of the parts' tests (a coupler, a rocker, a bias leaf) as a build that was read."""

from mdlcad.view.built import Built, Reported
from mdlcad.view.describe import Card, Catalogue
from tests.parts.device import small_device


def small_built() -> Built:
    device = small_device()
    report = Reported("small", "parametron", "pom_cut", "0.1.0", 6, 2, 4, None, None, (), {})
    bodies = device.bodies()
    return Built(report, None, device.network, device.placement, device.sizing, device.process, bodies, ())  # type: ignore[arg-type]


def cards_of(built: Built) -> tuple[Card, ...]:
    catalogue = Catalogue(built)
    return tuple(catalogue.card(body) for body in built.bodies)
