"""The pages of the Python and C++ APIs, as reStructuredText for Sphinx."""

import re
import sys
from collections import Counter
from pathlib import Path
from xml.etree import ElementTree

import aspic
import aspic.gym

PYTHON = {
    "Scenes": "load scenes parameters Scene BuiltinScene Parameter",
    "Simulations": "Simulation resume Advance SolveStatistics Pull Body Ball Skin Measures Quantities Springs",
    "States": "State compare Difference QuantityDifference",
    "Trajectories": "Trajectory BatchTrajectory Energy Diagnostic",
    "Batches": "Batch Instance",
    "Sweeps": "sweep collect Table",
    "Devices": "devices Device",
    "Errors and warnings": "Error ErrorCode UsageError SceneError DivergedError DeviceError FileError CheckError "
    "InterruptedRun RunWarning StepWarning OverlapWarning ConvergenceWarning",
}
GYM = "BatchEnv SingleEnv Walk WalkEnv walker Crawl CrawlEnv crawler"
# Bases whose members are not repeated; those of private bases are.
BASES = "object, tuple, int, Enum, BaseException, OSError, Error, Mapping, ndarray, BatchEnv, SingleEnv, Env, VectorEnv"


def heading(title: str) -> str:
    return f"{title}\n{'=' * len(title)}\n\n"


def check(module: str, documented: set[str]) -> None:
    if difference := documented ^ set(sys.modules[module].__all__):
        sys.exit(f"{module}.__all__ and docs/site/api.py differ in {', '.join(sorted(difference))}: change the latter.")


def directives(module: str, names: str) -> str:
    text = f".. currentmodule:: {module}\n"
    for name in names.split():
        if isinstance(getattr(sys.modules[module], name), type):
            text += f"\n.. autoclass:: {name}\n   :members:\n   :inherited-members: {BASES}\n"
            text += "   :undoc-members:\n" * (name == "ErrorCode")
            text += "   :show-inheritance:\n" * name.endswith(("Error", "Warning"))
        else:
            text += f"\n.. autofunction:: {name}\n"
    return text


def python_pages() -> dict[str, str]:
    """Texts by file name."""
    check("aspic", set(" ".join(PYTHON.values()).split()))
    check("aspic.gym", {*GYM.split(), "AutoresetMode"})
    pages = {title.split()[0].lower(): heading(title) + directives("aspic", names) for title, names in PYTHON.items()}
    gym = heading("aspic.gym") + ".. automodule:: aspic.gym\n\n" + directives("aspic.gym", GYM)
    return pages | {"gym": gym}


def share_comments(xml: Path) -> None:
    """Gives the comment of `int a, b;  ///< …` to a, too: Doxygen has it for b alone."""
    for file in xml.glob("*.xml"):
        tree = ElementTree.parse(file)
        for section in tree.iter("sectiondef"):
            members = section.findall("memberdef")
            for member, after in reversed(list(zip(members, members[1:]))):
                lines = {place.attrib["line"] for row in (member, after) for place in row.findall("location")}
                for kind in ("briefdescription", "detaileddescription"):
                    for own, other in zip(member.findall(kind), after.findall(kind)):
                        if len(lines) == 1 and not len(own):
                            own.extend(list(other))
        tree.write(file, encoding="utf-8", xml_declaration=True)


def cpp_pages(headers: Path, xml: Path) -> dict[str, str]:
    """Texts by file name, one for each header: its declarations in their order, which Doxygen's XML tells."""
    share_comments(xml)
    rows: dict[str, list[tuple[int, str]]] = {}

    def add(node: ElementTree.Element, directive: str) -> None:
        place = node.find("location")
        assert place is not None
        rows.setdefault(Path(place.attrib["file"]).name, []).append((int(place.attrib["line"]), directive))

    for found in ElementTree.parse(xml / "index.xml").findall("compound"):
        kind, name = found.attrib["kind"], found.findtext("name", "")
        if kind in ("class", "struct") and name.count("::") == 1:  # a class inside of another is on that one's page
            for compound in ElementTree.parse(xml / f"{found.attrib['refid']}.xml").findall("compounddef"):
                add(compound, f"doxygen{kind}:: {name}\n   :members:\n   :undoc-members:")
    members = ElementTree.parse(xml / "namespaceaspic.xml").findall("compounddef/sectiondef/memberdef")
    count = Counter(member.findtext("name") for member in members)
    for member in members:
        kind, name = member.attrib["kind"], member.findtext("name", "")
        arguments = member.findtext("argsstring") if kind == "function" and count[name] > 1 else ""
        add(member, f"doxygen{kind}:: aspic::{name}{arguments}")

    pages = {}
    for header, found_in in sorted(rows.items()):
        about = re.match(r"#pragma once\n((?:// .*\n)+)", (headers / header).read_text())
        assert about, f"{header} has no comment below #pragma once"
        text = heading(f"aspic/{header}") + about[1].replace("// ", "")
        pages[Path(header).stem] = text + "".join(f"\n.. {directive}\n" for _, directive in sorted(found_in))
    return pages
