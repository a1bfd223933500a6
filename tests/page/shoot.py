"""shoot.py PAGE SECONDS IMAGE …: the window of Chromium with each page at a moment, as a PNG, the first one light, others dark."""
import sys

import browser

b = browser.start(browser.Chromium)
try:
    words = sys.argv[1:]
    for i in range(0, len(words), 3):
        b.open(words[i], 1280, 760, dark=i > 0)
        b.call(f"aspic.player.seek({words[i + 1]}); aspic.changed(); await new Promise((go) => setTimeout(go, 3000))")
        with open(words[i + 2], "wb") as file:
            file.write(b.screenshot())
finally:
    b.close()
