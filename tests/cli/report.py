"""The page of `clast report` in headless Chromium, as a reader uses it. usage: report.py SUPPORT CLAST PAGE STORE OTHER

STORE is what the page was made from, OTHER is a store to drop on it."""
import base64
import csv
import gzip
import io
import json
import os
import re
import shlex
import sqlite3
import subprocess
import sys

support, clast, page, store, other = sys.argv[1:6]
sys.path.insert(0, support)
from browser import Browser  # noqa: E402

HOSTILE = "</script><img src=x onerror=hacked=1>\"'&<b>"


def done(text):
    print("ok page:", text)


def wait_shown(browser, count):
    browser.until(f"Number(document.body?.dataset.shown) >= {count}")


def shown(browser):
    return browser.js("Number(document.body.dataset.shown)")


def text(browser, selector):
    return browser.js(f"document.querySelector({json.dumps(selector)}).textContent")


def keep_downloads(browser):
    browser.js("window.kept = []; const make = URL.createObjectURL; "
               "URL.createObjectURL = (blob) => { kept.push(blob); return make(blob); }; 0")


def taken(browser, figure, button):
    """The file that a button below a chart gives."""
    browser.js(f"[...document.querySelectorAll({json.dumps(figure)} + ' .tools button')].find((b) => b.textContent === '{button}').click()")
    browser.until("kept.length > 0")
    return browser.js("kept.pop().text()")


def rows_of(command):
    return list(csv.DictReader(io.StringIO(subprocess.run([clast, *command], capture_output=True, text=True, check=True).stdout)))


def places(browser):
    """Middle of each cell of the plane, by row from the top and from left to right."""
    browser.js("document.querySelector('#plane-chart').scrollIntoView()")
    boxes = browser.js("[...document.querySelectorAll('#plane-chart .mark-rect path[aria-roledescription]')].map((p) => p.getBoundingClientRect()).map((r) => [r.x + r.width / 2, r.y + r.height / 2])")
    unique = sorted({(round(y), round(x)) for x, y in boxes})
    return [(x, y) for y, x in unique]


def look_at_start(browser):
    browser.open(page)
    wait_shown(browser, 1)
    assert browser.js("document.getElementById('status').textContent") == "", "the page complains"
    assert text(browser, "h1") == HOSTILE and browser.js("document.title") == HOSTILE + " - clast"
    assert browser.js("typeof hacked") == "undefined" and not browser.js("document.querySelector('img[src=x]')")
    done("a hostile name is text")
    asked = text(browser, "#asked")
    assert "4 points" in asked and "12 runs" in asked and "threshold.strain" in asked and "Nothing failed" in asked, asked
    table = browser.js("[...document.querySelectorAll('#asked tbody tr')].map((r) => [...r.cells].map((c) => c.textContent.trim()).slice(0, 3))")
    assert table == [["threshold.angle", "2, 6", "deg"], ["threshold.strain", "2, 5", "%"]], table
    assert "angle 2 deg, strain 2 %" in text(browser, "#spectrum figcaption"), text(browser, "#spectrum figcaption")
    done("it says what was asked and computed, in the units of the campaign")


def brush(browser):
    cells = places(browser)
    assert len(cells) == 4, cells
    before, count = text(browser, "#spectrum figcaption"), shown(browser)
    (x, y), (x2, y2) = cells[0], cells[1]
    browser.drag((x - 30, y - 8), (x2 + 30, y2 + 8))
    wait_shown(browser, count + 1)
    browser.wait(0.3)
    after = text(browser, "#spectrum figcaption")
    assert after != before and "Chosen: point" in text(browser, "#chosen"), (before, after)
    chosen = browser.js("new URLSearchParams(location.hash.slice(1)).get('points')").split(".")
    assert len(chosen) == 2, chosen
    drawn = list(csv.DictReader(io.StringIO(taken(browser, "#spectrum", "CSV"))))
    table = [row for row in rows_of(["spectrum", store, "--csv"]) if row["point_id"] in chosen]
    got = sorted((float(r["lower_kg"]), float(r["density"]), float(r["density_hw95"])) for r in drawn)
    want = sorted((float(r["lower"]), float(r["density"]), float(r["density_hw95"])) for r in table)
    assert len(got) == len(want) > 10, (len(got), len(want))
    for a, b in zip(got, want):
        assert all(abs(u - v) <= 2e-6 * abs(v) for u, v in zip(a, b)), (a, b)
    assert taken(browser, "#spectrum", "SVG").startswith("<svg")
    done("a brush over two cells draws their spectra, with the numbers of clast spectrum")


def keyboard(browser):
    count = shown(browser)
    browser.js("document.querySelector('#points').open = true; document.querySelector('#points input:not(:checked)').focus()")
    for kind in ("keyDown", "keyUp"):
        browser.call("Input.dispatchKeyEvent", type=kind, key=" ", code="Space", text=" ", windowsVirtualKeyCode=32)
    wait_shown(browser, count + 1)
    assert len(browser.js("new URLSearchParams(location.hash.slice(1)).get('points')").split(".")) == 3
    done("the space bar chooses a point")


def seeds(browser):
    rows = list(csv.DictReader(io.StringIO(taken(browser, "#seeds", "CSV"))))
    points = browser.js("new URLSearchParams(location.hash.slice(1)).get('points')")
    with sqlite3.connect(f"file:{store}?mode=ro", uri=True) as db:
        want = [v for (v,) in db.execute(f"select largest_fraction from run where counts and point_id in ({points.replace('.', ',')})")]
    got = sorted(float(row["largest_fraction"]) for row in rows)
    assert len(got) == len(want) == 9 and all(abs(a - b) < 1e-6 for a, b in zip(got, sorted(want))), (got, want)
    done("the histogram holds the runs of the points")


def one_run(browser):
    browser.js("document.querySelector('#runs tbody button').click()")
    browser.until("document.querySelectorAll('#runs .pictures img').length > 0 && [...document.querySelectorAll('#runs .pictures img')].every((i) => i.naturalWidth > 100)")
    command = browser.js("document.querySelector('#run code').textContent")
    words = shlex.split(command)
    assert words[:2] == ["clast", "replay"], command
    subprocess.run([clast, *words[1:]], check=True, capture_output=True)
    assert os.path.exists(words[-1])
    done("kept fields are pictures; a run shows the command that computes it again, and it works")


def sql(browser):
    question = "SELECT point_id, count(*) AS runs, round(avg(largest_fraction), 4) AS m FROM runs GROUP BY point_id"
    browser.js(f"document.querySelector('#sql').value = {json.dumps(question)}; document.querySelector('#ask').click()")
    got = browser.js("[...document.querySelectorAll('#answer tbody tr')].map((r) => [...r.cells].map((c) => c.textContent))")
    with sqlite3.connect(f"file:{store}?mode=ro", uri=True) as db:
        want = [[str(v) for v in row] for row in db.execute(question.replace("runs GROUP", "run GROUP"))]
    assert got == want and len(got) == 4, (got, want)
    count = browser.js("document.querySelectorAll('#query [role=group] button').length")
    assert count > 8, count
    for i in range(count):
        browser.js(f"document.querySelectorAll('#query [role=group] button')[{i}].click()")
        assert "SQL error" not in text(browser, "#answer"), text(browser, "#answer")
    browser.js("document.querySelector('#sql').value = 'SELECT missing FROM runs'; document.querySelector('#ask').click()")
    assert "no such column" in text(browser, "#answer"), text(browser, "#answer")
    done(f"SQL answers as the store does, {count} ready questions work, an error is told")
    browser.open(page, "#sql=SELECT+6*7+AS+answer")
    wait_shown(browser, 1)
    assert text(browser, "#answer td") == "42"
    done("a link holds a question")


def drop(browser):
    count = shown(browser)
    browser.drop_file(other, 300, 300)
    wait_shown(browser, count + 1)
    browser.until("document.querySelector('#status').textContent.includes('is added')")
    assert "The stores side by side" in text(browser, "#compare") and not browser.js("document.querySelector('#compare').hidden")
    with sqlite3.connect(f"file:{other}?mode=ro", uri=True) as db:
        (mean,) = db.execute("select avg(largest_fraction) from run where counts and point_id = 1").fetchone()
    assert f"mean{mean:.4g}" in text(browser, "#seeds .body"), (mean, text(browser, "#seeds .body"))
    whole_store(browser)
    with open("no-store.db", "w") as file:
        file.write("this is no store")
    browser.choose_file("#file", "no-store.db")
    browser.until("document.querySelector('#status').textContent.includes('cannot be read')")
    done("a store dropped on the page is read and compared; another file is refused")


def whole_store(browser):
    """What the page computes itself of a store that was dropped: all points as one spectrum, means of any result."""
    count = shown(browser)
    browser.js("for (const box of document.querySelectorAll('#points input')) box.checked = true; "
               "document.querySelector('#points input').dispatchEvent(new Event('change'))")
    wait_shown(browser, count + 1)
    drawn = list(csv.DictReader(io.StringIO(taken(browser, "#spectrum", "CSV"))))
    table = rows_of(["spectrum", other, "--by", "", "--csv"])
    assert len(drawn) == len(table) > 10, (len(drawn), len(table))
    for a, b in zip(drawn, table):
        for got, want in ((a["lower_kg"], b["lower"]), (a["density"], b["density"]), (a["density_hw95"], b["density_hw95"])):
            assert abs(float(got) - float(want)) <= 1e-9 * abs(float(want)), (a, b)
    count = shown(browser)
    browser.js("const box = document.querySelector('[name=quantity]'); box.value = 'broken'; box.dispatchEvent(new Event('change')); 0")
    wait_shown(browser, count + 1)
    drawn = list(csv.DictReader(io.StringIO(taken(browser, "#plane-chart", "CSV"))))
    table = rows_of(["stats", other, "--by", "angle,strain", "--quantity", "broken", "--csv"])
    got = sorted((float(row["mean"]), float(row["hw95"])) for row in drawn)
    want = sorted((float(row["broken_mean"]), float(row["broken_hw95"])) for row in table)
    assert len(got) == len(want) == 8, (got, want)
    for a, b in zip(got, want):
        assert all(abs(u - v) <= 1e-5 * abs(v) for u, v in zip(a, b)), (a, b)
    done("of a dropped store, pooled spectra and means are those of clast")


def loads_again(browser):
    """As a page of --watch: it loads itself again after a second, with what was chosen."""
    html = open(page, encoding="utf-8").read()
    (data,) = re.findall(r'class="store">([^<]*)<', html)
    with sqlite3.connect(":memory:") as db:
        db.deserialize(gzip.decompress(base64.b64decode(data)))
        db.execute("UPDATE fact SET value = '1' WHERE name = 'refresh'")
        db.commit()
        changed = base64.b64encode(gzip.compress(db.serialize())).decode()
    with open("again.html", "w", encoding="utf-8") as file:
        file.write(html.replace(data, changed))
    browser.open("again.html", "#points=3")
    wait_shown(browser, 1)
    start = browser.js("performance.timeOrigin")
    browser.until(f"performance.timeOrigin !== {start} && document.body?.dataset.shown >= 1")
    assert "point 3" in text(browser, "#chosen")
    done("a page of a running campaign loads itself again, and keeps what was chosen")


def widths(browser):
    for width in (1280, 768, 390):
        browser.size(width, 900)
        browser.wait(0.6)
        wide = browser.js("document.documentElement.scrollWidth")
        assert wide <= width, f"{wide} pixels wide on a screen of {width}"
    done("it fits three widths")


with Browser() as browser:
    look_at_start(browser)
    keep_downloads(browser)
    brush(browser)
    keyboard(browser)
    seeds(browser)
    one_run(browser)
    sql(browser)
    loads_again(browser)
    browser.open(page)
    wait_shown(browser, 1)
    keep_downloads(browser)
    drop(browser)
    widths(browser)
    assert browser.complaints == [], browser.complaints
    outside = [url for url in browser.requests if not url.startswith(("file:", "blob:", "data:", "about:"))]
    assert outside == [], outside
    done("no error in the console, no request to a network")
