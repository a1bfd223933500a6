"""Sphinx's configuration of the documentation site; docs/site/build.py adds the folders."""
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

project = "Aspic"
copyright = "the authors of Aspic, MIT license"
release = re.search(r"project\(aspic VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
extensions = ["myst_parser", "breathe", "sphinx.ext.autodoc", "sphinx_copybutton"]
myst_enable_extensions = ["attrs_block", "colon_fence"]
myst_heading_anchors = 4
suppress_warnings = ["myst.header"]

autodoc_member_order = "bysource"
autoclass_content = "both"
autodoc_typehints_format = "short"
python_maximum_signature_line_length = 88
cpp_maximum_signature_line_length = 88
add_module_names = False

breathe_default_project = "aspic"

html_theme = "furo"
html_title = f"Aspic {release}"
html_static_path = ["site.css"]
html_css_files = ["site.css"]
html_copy_source = False
html_show_sphinx = False
copybutton_exclude = ".linenos, .gp, .go"
copybutton_prompt_text = "$ "
# scripts/docs.sh --external
linkcheck_timeout = 15
linkcheck_retries = 2
