"""What the report says: its sections, tables and the words between the figures."""

import re
from collections.abc import Mapping, Sequence

from markdown_it import MarkdownIt

from frictioncontact.parameters import IDENTIFIED
from frictioncontact.periodic import reduction
from frictioncontact.table2 import Result, conditions
from workshop.figure import Figure
from workshop.paper.claims import Claim
from workshop.project import ROOT
from workshop.report.page import Section, Table
from workshop.report.page import text as as_html

TITLE = "Friction under ultrasonic vibration: a paper reproduced and corrected"

LAW = """<div class="law">
<math displaystyle="true">
<mfrac><mrow><mi>d</mi><mi>δ</mi></mrow><mrow><mi>d</mi><mi>t</mi></mrow></mfrac><mo>=</mo><mi>V</mi>
<mo>−</mo><mfrac><mrow><mi>σ</mi><mo>|</mo><mi>V</mi><mo>|</mo></mrow><msub><mi>F</mi><mi>C</mi></msub></mfrac>
<mi>δ</mi></math>
<math displaystyle="true"><msub><mi>F</mi><mi>t</mi></msub><mo>=</mo><mi>σ</mi><mi>δ</mi></math>
<math displaystyle="true">
<mi>σ</mi><mo>=</mo><mfrac><mrow><mi>E</mi><msubsup><mi>A</mi><mi>r</mi><mn>2</mn></msubsup></mrow>
<msup><mi>d</mi><mn>3</mn></msup></mfrac></math></div>"""

LEDE = f"""<p>A. Fattahi Avati and M. R. Karafi, <cite>Theoretical Study of Effective Parameters in the
Friction Reduction by Ultrasonic Vibrations in Solid Surfaces</cite> (Iranian Journal of Mechanical
Engineering, 2022, doi 10.30506/JMEE.2022.552079.1288), combines Dahl's friction law with an elastic-plastic
contact of asperities. FrictionContact.fmu computes that model. This page sets what the equations give beside
what the paper prints.</p>{LAW}"""


def sections(table: Sequence[Result], made: Sequence[Claim], figures: Mapping[str, Figure]) -> list[Section]:
    """The report, top to bottom."""
    return [
        Section("claims", "The claims", CLAIMS_INTRO, [_claims(made)]),
        Section("table-2", "Table 2", TABLE_2_INTRO, [_table_2(table)]),
        Section(
            "figures",
            "The figures",
            FIGURES_INTRO,
            [figure for key, figure in figures.items() if key.startswith("fig-")],
        ),
        Section("heights-and-load", "Heights and load", HEIGHTS_INTRO, [figures["heights"]]),
        Section(
            "regimes-and-limits",
            "Regimes",
            REGIMES_INTRO,
            [figures[key] for key in ("regimes", "mean", "reduction")],
        ),
        Section(
            "sensitivities",
            "Sensitivities",
            SENSITIVITY_INTRO,
            [figures["sensitivity-cuts"]],
        ),
        Section("errata", "Errata", errata(), []),
        Section("identification", "Identification", IDENTIFY_INTRO, [figures["recovery"]]),
    ]


def errata() -> str:
    """docs/errata.md as a part of the page, without its title, links and figures."""
    text = (ROOT / "docs" / "errata.md").read_text(encoding="utf-8")
    text = text[text.index("The FMU computes") :]
    text = re.sub(r"!\[[^\]]*\]\([^)]*\)\n", "", text)
    text = re.sub(r"\[([^\]]+)\]\([^)]*\)", r"docs/\1", text).replace("docs/tests/", "tests/")
    made = MarkdownIt().render(re.sub(r"(?m)^##", "###", text))
    parts = re.split(r"(<code>.*?</code>)", made, flags=re.DOTALL)
    return "".join(part if part.startswith("<code>") else as_html(part) for part in parts)


CLAIMS_INTRO = """<p>Changes in percent as the abstract and the conclusion state them, at the printed
parameters (σ = 5.743e12 N/m, V = 5 mm/s, phase 0), and with the identified stiffness, phase and velocity.
The proofs are under <a href="#errata">Errata</a>.</p>"""

TABLE_2_INTRO = f"""<p>Mean friction force of the six rows. <b>Exact</b> is what Eq. 1–2 give as periodic
means at the printed parameters. <b>Identified</b> uses the velocity of Figures 3 and 4, {IDENTIFIED.V} m/s,
a hundred times
that of Table 1, and a stiffness and a phase chosen so that rows 2, 3 and 6 are missed by the same 0.56 N:
{IDENTIFIED.stiffness / 1e6:.4f} MN/m at 14 µm and {IDENTIFIED.phase_d}° between the separation's
and the velocity's vibration. Three adjusted numbers for three informative rows: an identification, not a
validation. Rows 4 and 5 can't be reached: V is constant there, and the mean is F<sub>C</sub>.</p>"""

FIGURES_INTRO = """<p>Each from the FMU, at the printed parameters and at the identified stiffness of 2.5366
MN/m. Figures 1, 7 and 14 of the paper are sketches and a measurement by others.</p>"""

HEIGHTS_INTRO = """<p>Eq. 17 replaces the Gaussian density of asperity heights by an exponential, so that
areas have a closed form. The FMU keeps it. The Gaussian integrals here are by quadrature, checked against
the package ContactMechanics.</p>"""

REGIMES_INTRO = """<p>Three numbers place a vibrating contact: κ = σ V<sub>1</sub> / (2π f F<sub>C</sub>),
how far the vibration moves the contact in units of the deflection at which it slips; ζ = V / V<sub>1</sub>;
and a<sub>d</sub> / R<sub>q</sub>, how much the separation moves.</p>"""

SENSITIVITY_INTRO = """<p>By central differences of the FMU's F_t_mean in the periodic state.</p>"""

IDENTIFY_INTRO = """<p><code>scripts/identify</code> fits any parameters to measured mean friction. On rows
2, 3 and 6 of Table 2 least squares gives 2.383 MN/m and 224.7°, with residuals of 0.65, −0.36 and −0.58 N.
With one degree of freedom its 95 % intervals by profile likelihood are so wide (any stiffness up to 15 MN/m,
phases from 45° to 306°) that the table does not determine either number; a second minimum at 127° lies within
them. With enough data the method does recover what made them:</p>"""


def _claims(made: Sequence[Claim]) -> Table:
    rows = []
    for claim in made:
        identified = "" if claim.identified is None else _percent(claim.identified)
        rows.append(
            [
                claim.words,
                f"{claim.printed:+.0f}".replace("-", "−"),
                _percent(claim.exact),
                identified,
                as_html(claim.why),
            ]
        )
    heading = ("Change of the mean, in %", "paper", "exact", "identified", "why")
    return Table(heading, rows, words=(0, 4))


def _percent(value: float) -> str:
    value = 0.0 if abs(value) < 5e-7 else value
    digits = 0 if value == 0.0 else 2
    return f"{value:+.{digits}f}".replace("-", "−").replace("+0", "0", 1 if value == 0.0 else 0)


def _table_2(table: Sequence[Result]) -> Table:
    first = table[0]
    rows = []
    for result in table:
        row = result.row
        rows.append(
            [
                f"{row.number}: {_html_conditions(row)}",
                f"{row.paper_force:.0f}",
                f"{row.paper_reduction:.0f} %",
                f"{result.exact:.4f}",
                _reduced(result.exact, first.exact, 2),
                f"{result.identified:.2f}",
                _reduced(result.identified, first.identified, 1),
            ]
        )
    heading = ("Row", "paper, N", "less by", "exact, N", "less by", "identified, N", "less by")
    return Table(heading, rows)


def _reduced(mean: float, without: float, digits: int) -> str:
    return f"{round(reduction(mean, without), digits) + 0.0:.{digits}f} %"


def _html_conditions(row: object) -> str:
    plain = conditions(row).replace("$", "")  # type: ignore[arg-type]
    return re.sub(r"_(\w)", r"<sub>\1</sub>", plain)
