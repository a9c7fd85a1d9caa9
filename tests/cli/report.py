"""The page of `clast report` in headless Chromium, as a reader uses it. usage: report.py SUPPORT CLAST PAGE STORE OTHER MARKED THREE

STORE is what the page was made from, OTHER is a store to drop on it. MARKED.html is
the page of MARKED.db, of which the points 2 and 4 are in doubt. THREE.html is the page of THREE.db with three varied inputs."""
import base64
import csv
import gzip
import io
import json
import os
import re
import shlex
import shutil
import sqlite3
import subprocess
import sys

support, clast, page, store, other, marked, three = sys.argv[1:8]
sys.path.insert(0, support)
from browser import Browser  # noqa: E402

HOSTILE = "</script><img src=x onerror=hacked=1>\"'&<b>"


def done(text):
    print("ok page:", text)


def wait_shown(browser, count):
    browser.until(f"Number(document.body?.dataset.shown) >= {count}")


def chosen(browser):
    points = browser.js("new URLSearchParams(location.hash.slice(1)).get('points')")
    return [int(point) for point in points.split(".")] if points else []


def wait_chosen(browser, count):
    """Until so many points are chosen, and all of the page shows them."""
    browser.until(f"(new URLSearchParams(location.hash.slice(1)).get('points') ?? '').split('.').length === {count} && document.body.ariaBusy !== 'true'")


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
    commands = browser.js("[...document.querySelectorAll('figure code')].map((c) => c.textContent)")
    assert len(commands) == 3, commands
    for command in commands:
        subprocess.run([clast, *shlex.split(command)[1:]], check=True, capture_output=True)
    done("the commands below the charts work")


def brush(browser):
    cells = places(browser)
    assert len(cells) == 4, cells
    before = text(browser, "#spectrum figcaption")
    (x, y), (x2, y2) = cells[0], cells[1]
    browser.drag((x - 30, y - 8), (x2 + 30, y2 + 8))
    wait_chosen(browser, 2)
    after = text(browser, "#spectrum figcaption")
    assert after != before and "Chosen: point" in text(browser, "#chosen"), (before, after)
    drawn = list(csv.DictReader(io.StringIO(taken(browser, "#spectrum", "CSV"))))
    table = [row for row in rows_of(["spectrum", store, "--csv"]) if int(row["point_id"]) in chosen(browser)]
    got = sorted((float(r["lower_kg"]), float(r["number_density"]), float(r["number_density_hw95"] or 0)) for r in drawn)
    want = sorted((float(r["lower"]), float(r["number_density"]), float(r["number_density_hw95"] or 0)) for r in table)
    assert len(got) == len(want) > 10, (len(got), len(want))
    for a, b in zip(got, want):
        assert all(abs(u - v) <= 2e-6 * abs(v) for u, v in zip(a, b)), (a, b)
    assert taken(browser, "#spectrum", "SVG").startswith("<svg")
    done("a brush over two cells draws their spectra, with the numbers of clast spectrum")


def keyboard(browser):
    """Only keys: in the table of points, and to a run."""
    browser.js("document.querySelector('#points').open = true; document.querySelector('#points input:not(:checked)').focus()")
    browser.key(" ")
    wait_chosen(browser, 3)
    browser.js("document.querySelector('#runs tbody button').focus()")
    browser.key("Enter")
    assert browser.js("document.activeElement.id") == "run-title" and "clast replay" in text(browser, "#run code")
    done("the space bar chooses a point in the table, Enter shows a run")


def seeds(browser):
    rows = list(csv.DictReader(io.StringIO(taken(browser, "#seeds", "CSV"))))
    points = ",".join(map(str, chosen(browser)))
    with sqlite3.connect(f"file:{store}?mode=ro", uri=True) as db:
        want = [v for (v,) in db.execute(f"select largest_fraction from run where counts and point_id in ({points})")]
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
    browser.js("document.querySelector('#answer summary').click()")
    browser.until("document.querySelectorAll('#answer figure svg .mark-symbol path').length === 4")
    browser.js("const up = document.querySelector('#answer [name=up]'); up.value = 'm'; up.dispatchEvent(new Event('change')); 0")
    browser.until("document.querySelector('#answer figcaption').textContent.startsWith('m against')")
    drawn = list(csv.reader(io.StringIO(taken(browser, "#answer figure", "CSV"))))
    assert drawn[0] == ["point_id", "m"] and drawn[1:] == [[row[0], row[2]] for row in want], (drawn, want)
    heights = browser.js("[...document.querySelectorAll('#answer figure svg .mark-symbol path')].map((p) => p.getBoundingClientRect()).map((r) => [r.x, r.y])")
    order = [y for _, y in sorted(heights)]
    assert sorted(range(4), key=lambda i: -order[i]) == sorted(range(4), key=lambda i: float(want[i][2])), (heights, want)
    done("an answer is drawn as a chart, with its CSV")
    # More digits than a double has: in the table, the file, the chart and its file.
    digits = [["9007199254740993", "0.5"], ["-9223372036854775808", "0.25"], ["7", "9007199254740995"]]
    question = "SELECT column1 AS seed, column2 AS m FROM (VALUES " + ", ".join(f"({a}, {b})" for a, b in digits) + ")"
    browser.js(f"document.querySelector('#sql').value = {json.dumps(question)}; document.querySelector('#ask').click()")
    got = browser.js("[...document.querySelectorAll('#answer tbody tr')].map((r) => [...r.cells].map((c) => c.textContent))")
    assert got == digits, got
    assert list(csv.reader(io.StringIO(taken(browser, "#answer", "CSV"))))[1:] == digits
    browser.js("document.querySelector('#answer summary').click()")
    browser.until("document.querySelectorAll('#answer figure svg .mark-symbol path').length === 3")
    assert list(csv.reader(io.StringIO(taken(browser, "#answer figure", "CSV"))))[1:] == digits
    done("integers have the digits of the store")
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
        widest = "select point_id from spectra group by 1 order by count(*) desc, 1 limit 1"  # the page opens there
        (mean,) = db.execute(f"select avg(largest_fraction) from run where counts and point_id = ({widest})").fetchone()
    assert f"mean{mean:.2f} ± " in text(browser, "#seeds .body"), (mean, text(browser, "#seeds .body"))
    whole_store(browser)
    written_store(browser)
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
        assert a["number_density_hw95"] == ""  # needs the runs: points share seeds
        for got, want in ((a["lower_kg"], b["lower"]), (a["number_density"], b["number_density"])):
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


def written_store(browser):
    """The file of a store that is being written: what is newest is in its -wal file only, which a reader does not drop."""
    shutil.copy(other, "writing.db")
    with sqlite3.connect("writing.db") as db:
        assert db.execute("pragma journal_mode = wal").fetchone() == ("wal",)
        db.execute("pragma wal_autocheckpoint = 0")
        db.execute("update campaign set name = 'later'")
        db.commit()
        assert os.path.getsize("writing.db-wal") > 0
        browser.choose_file("#file", "writing.db")
        browser.until("document.querySelector('#status').textContent.startsWith('writing.db is added')")
    asked = text(browser, "#asked")
    assert asked.count("24 runs in statistics") == 2 and "later" not in asked, asked
    assert "without its -wal file the last runs may be missing" in asked, asked
    done("the file of a store that is being written is read, and the page says what may be missing")


def alter(page, to, *statements):
    """A copy of the page with other data."""
    html = open(page, encoding="utf-8").read()
    (data,) = re.findall(r'class="store">([^<]*)<', html)
    with sqlite3.connect(":memory:") as db:
        db.deserialize(gzip.decompress(base64.b64decode(data)))
        for statement in statements:
            db.execute(statement)
        db.commit()
        with open(to, "w", encoding="utf-8") as file:
            file.write(html.replace(data, base64.b64encode(gzip.compress(db.serialize())).decode()))


def loads_again(browser):
    """As a page of --watch: it loads itself again after a second, with what was chosen. Two modes of any result are marked."""
    alter(page, "again.html",
          "UPDATE fact SET value = '1' WHERE name = 'refresh'",
          "INSERT INTO modes VALUES (3, 'broken', 20, 60, 40, 0.25, 0.1, 0.5)",
          "DELETE FROM doubt WHERE point_id = 3",
          "INSERT INTO doubt VALUES (3, 'sph', 'box', 3)",
          "INSERT INTO doubt_mark VALUES ('sph', 'box', 'largest_fraction', 'box', 1)",
          "UPDATE runs SET largest_fraction = NULL",
          "INSERT INTO campaign SELECT campaign_id + n, 'more ' || min(n, 4), iif(n = 1, '# Written by clast find: a round of its runs.\n', '') || document, added_at FROM campaign, (SELECT 1 AS n UNION SELECT 2 UNION SELECT 3 UNION SELECT 4 UNION SELECT 5)",
          "INSERT INTO campaign_point SELECT 5, min(point_id) FROM campaign_point UNION SELECT 6, max(point_id) FROM campaign_point")
    browser.open("again.html", "#points=3&quantity=broken")
    wait_shown(browser, 1)
    start = browser.js("performance.timeOrigin")
    browser.until(f"performance.timeOrigin !== {start} && document.body?.dataset.shown >= 1")
    # The page may be loading itself again at any moment: each look at it is one expression.
    browser.until("document.querySelector('#chosen')?.textContent.includes('point 3')")
    browser.until("document.querySelector('#plane-chart svg')?.textContent.split('◆').length === 2"
                  " && document.querySelector('#points').textContent.includes('two: 20 and 60')")
    done("two modes of a result that is no main one are marked")
    browser.until("document.querySelector('h1')?.textContent.endsWith(', more 2, more 3 and 1 more')")
    browser.until("[...document.querySelectorAll('#asked summary')].slice(-2).map((s) => s.textContent).join() === 'The campaign file of more 4, number 5,The campaign file of more 4, number 6'")
    done("a title names three campaigns, and no search whose points the page leaves out")
    browser.open("again.html", "#points=3")
    browser.until("/has a value of this quantity. !: in doubt, 3 of 3 runs: box .explained above../.test(document.querySelector('#seeds')?.textContent)")
    done("values that are withheld are told with their reason")
    browser.open(page, "#quantity=beta")
    wait_shown(browser, 1)
    assert "the exponent is too uncertain to print: fewer than 5 fragments" in text(browser, "#plane-chart"), text(browser, "#plane-chart")
    assert "no β: fewer than 5 fragments" in text(browser, "#spectrum figcaption"), text(browser, "#spectrum figcaption")
    done("an exponent that no table shows is not drawn, and the page says why")
    done("a page of a running campaign loads itself again, and keeps what was chosen")


def marks(browser):
    browser.open(f"{marked}.html#points=1.2")
    wait_shown(browser, 1)
    why = " !: in doubt, 6 of 12 runs. step: fidelity.time_step over the longest stable step is above 0.25: energy may drift; give a"
    caption = text(browser, "#plane-chart figcaption")
    assert why in caption and "that was studied at 1 point: >= 0.042." in caption, caption
    assert re.search(r", ([0-9]+) to ([0-9]+) grains, 3 seeds a point", text(browser, "#made")), text(browser, "#made")
    for figure in ("#seeds", "#spectrum"): # advice stands once
        below = text(browser, f"{figure} figcaption")
        assert " !: in doubt, 3 of 6 runs: step (explained above)." in below and "energy may drift" not in below, below
    table = "[...document.querySelectorAll('%s tbody tr')].map((r) => [...r.cells].map((c) => c.textContent.trim()))"
    rows = browser.js(table % "#points")
    assert [row[6][-2:] == " !" for row in rows] == [False, True, False, True] and rows[1][9] == "3 of 3 runs: step", rows
    assert browser.js("[...document.querySelectorAll('#plane-chart text')].filter((t) => t.textContent.includes(' !')).length") == 2
    mean = browser.js(table % "#seeds .body")[0]
    assert " !" not in mean[1] and " !, n=3" in mean[2], mean
    rows = browser.js(table % "#runs .body")
    assert len(rows) == 6 and all((row[4][-2:] == " !") == (row[1] == "2") and row[-1][-2:] != " !" for row in rows), rows
    done("numbers in doubt are marked, and captions say why")
    count = shown(browser)
    browser.choose_file("#file", f"{marked}.db")
    wait_shown(browser, count + 1)
    caption = text(browser, "#plane-chart figcaption")
    assert "!: in doubt, 6 of 12 runs. step: clast explain step." in caption, caption
    assert text(browser, "#compare .body").count(" !, n=3") == 4, text(browser, "#compare .body")
    done("a dropped store is marked by the words of its runs")


def slices(browser):
    """Where several points share a cell of the map, it shows one value of the other input; a click chooses no hidden point."""
    browser.open(f"{three}.html#points=1&x=threshold_strain&y=threshold_angle")
    wait_shown(browser, 1)
    keep_downloads(browser)
    of_value = []
    for value in ("1000", "2000"):
        count = shown(browser)
        browser.js(f"{{ const box = document.querySelector('[name=at-charge_energy]'); box.value = '{value}'; box.dispatchEvent(new Event('change')); }} 0")
        wait_shown(browser, count + 1)
        assert f"= {int(value) // 1000}. " in text(browser, "#plane-chart figcaption"), text(browser, "#plane-chart figcaption")
        rows = list(csv.DictReader(io.StringIO(taken(browser, "#plane-chart", "CSV"))))
        assert len({(row["threshold_strain"], row["threshold_angle"]) for row in rows}) == len(rows) == 4, rows
        of_value.append({int(row["point_id"]) for row in rows})
        command = shlex.split(text(browser, "#plane-chart code"))
        assert command[-2:] == ["--where", f"charge_energy IS {value}"], command
        subprocess.run([clast, *command[1:]], check=True, capture_output=True)
        with sqlite3.connect(f"{three}.db") as db:
            wanted = {row[0] for row in db.execute("SELECT point_id FROM points WHERE charge_energy = ?", (float(value),))}
        assert of_value[-1] == wanted, (of_value, wanted)
    assert len(set.union(*of_value)) == 8, of_value
    browser.js("document.querySelector('#runs tbody button').click()")
    with sqlite3.connect(f"{three}.db") as db:
        (seed,) = db.execute("SELECT seed FROM run WHERE run_id = ?", (int(text(browser, "#runs tbody button")),)).fetchone()
    pairs = browser.js("[...document.querySelectorAll('#run dt')].map((term) => [term.textContent, term.nextSibling.textContent])")
    assert seed > 1 << 53 and ["seed", str(seed)] in pairs, (seed, pairs)
    done("a map of three inputs shows one value of the third; a run has all digits of its seed")


def opens_on(browser):
    """Without a choice, the page of three inputs opens on the two with the largest effect: here not on the first two."""
    browser.open(f"{three}.html")
    wait_shown(browser, 1)
    pair = {browser.js(f"document.querySelector('#choices [name={axis}]').value") for axis in "xy"}
    with sqlite3.connect(f"{three}.db") as db:
        columns = [row[0] for row in db.execute("SELECT column_name FROM axis ORDER BY path")]
        spread = {c: [row[0] for row in db.execute(f"SELECT avg(largest_fraction_mean) FROM points GROUP BY {c}")] for c in columns}
    ranked = sorted(columns, key=lambda c: max(spread[c]) - min(spread[c]))
    assert pair == set(ranked[1:]) != set(columns[:2]), (pair, spread)
    browser.js("const box = document.querySelector('#choices [name=y]'); box.value = ''; box.dispatchEvent(new Event('change')); 0")
    browser.until("/From point to point .* change, too/.test(document.querySelector('#plane-chart figcaption').textContent)")
    done("a page of three inputs opens on those with an effect, and tells what changes behind the dots")


def scenes(browser):
    """A store of two scenes opens on the input that both have, and offers only commands that work."""
    browser.open("scenes.html")
    wait_shown(browser, 1)
    of = lambda axis: browser.js(f"document.querySelector('#choices [name={axis}]').value")
    assert (of("x"), of("y")) == ("body_diameter", ""), (of("x"), of("y"))
    table = browser.js("[...document.querySelectorAll('#asked tbody tr')].map((r) => [...r.cells].map((c) => c.textContent.trim()).slice(0, 2))")
    assert table == [["body.diameter", "7, 8"], ["charge.energy", "1, 2; none in 2 points"], ["collision.speed", "40, 90; none in 4 points"]], table
    offered = set()
    for x in ("body_diameter", "charge_energy", "collision_speed"):
        for y in {"", "body_diameter", "charge_energy", "collision_speed"} - {x}:
            browser.open(f"scenes.html#x={x}&y={y}&points=1")
            wait_shown(browser, 1)
            offered.add(text(browser, "#plane-chart code"))
    assert {command.split()[1] for command in offered} == {"map", "plot", "stats"}, offered
    for command in offered:
        subprocess.run([clast, *shlex.split(command)[1:]], check=True, capture_output=True)
    done("a page of two scenes offers commands that work")


def commands_of(browser, figure):
    return [shlex.split(line) for line in browser.js(f"[...document.querySelectorAll('{figure} code')].map((c) => c.textContent)")]


def drawn_together(browser, page, count):
    """The commands under the spectrum give the numbers of the chart; the page says which points it has, and lists their runs."""
    browser.open(page)
    wait_shown(browser, 1)
    keep_downloads(browser)
    chart = list(csv.DictReader(io.StringIO(taken(browser, "#spectrum", "CSV"))))
    commands = commands_of(browser, "#spectrum")
    pictures = [words[words.index("--picture") + 1] for words in commands]
    table = [row for words in commands for row in rows_of([*words[1:words.index("--picture")], "--csv"])]
    got, want = (sorted((float(r[mass]), float(r["number_density"])) for r in rows) for rows, mass in ((chart, "lower_kg"), (table, "lower")))
    assert len(got) == len(want) and all(abs(u - v) <= 2e-6 * v for a, b in zip(got, want) for u, v in zip(a, b)), (commands, len(got), len(want))
    assert len(set(pictures)) == len(commands) == count, commands
    names = browser.js("[...document.querySelectorAll('#seeds thead th')].map((h) => h.textContent).slice(1)")
    told, rows = text(browser, "#chosen"), browser.js("[...document.querySelectorAll('#runs tbody tr')].map((r) => r.cells[0].textContent)")
    stores = [name.split(": ")[0] for name in names]
    assert len(set(names)) == len(names) > 1 and all(f" of {name}" in told for name in stores), (names, told)
    assert rows == [name for name in stores for _ in range(3)], rows
    assert len(commands_of(browser, "#seeds")) == count
    for words in commands + commands_of(browser, "#seeds"):
        subprocess.run([clast, *words[1:]], check=True, capture_output=True)
        assert os.path.getsize(words[-1]) > 1000
    return names


def several(browser):
    drawn_together(browser, "two.html", 2)
    browser.open("two.html", "#points=1.2.3")
    wait_shown(browser, 1)
    assert "Points of the other stores are drawn beside one or two chosen points only." in text(browser, "#chosen")
    drawn_together(browser, "pair.html", 1)
    names = drawn_together(browser, "energies.html", 1)
    assert [re.search("energy .*/m", name)[0] for name in names] == ["energy 2000 J/m", "energy 3000 J/m"], names
    assert all(f"charge.energy{value} J/m" in text(browser, "#asked") for value in (2000, 3000)), text(browser, "#asked")
    assert "There is no room there for point 3 (3 runs) of small.db:3: choose it under Store." in open_text(browser, "seven.html", "#chosen")
    done("points of several stores and named points are drawn together, and the commands make the charts")


def open_text(browser, page, selector):
    browser.open(page)
    wait_shown(browser, 1)
    return text(browser, selector)


def ends(browser):
    """Marks lie within the frame of a chart, and only intervals that reach 0 touch its foot. ~ is told where the chart has it."""
    browser.open(f"{three}.html", "#x=threshold_strain&y=")
    wait_shown(browser, 1)
    keep_downloads(browser)
    boxes = lambda what: browser.js(f"[...document.querySelectorAll({json.dumps(what)})].map((e) => e.getBoundingClientRect()).map((r) => [r.left, r.top, r.right, r.bottom])")
    for figure in ("#plane-chart", "#spectrum"):
        left, top, right, bottom = boxes(f"{figure} .mark-group.role-frame path.background")[0]
        marks = boxes(f"{figure} .mark-symbol.role-mark path")
        assert len(marks) > 2 and all(left <= m[0] and m[2] <= right for m in marks), (figure, left, right, marks)
        assert figure != "#spectrum" or all(top <= m[1] and m[3] <= bottom for m in marks), (top, bottom, marks)
        (picture,), words = boxes(f"{figure} svg"), boxes(f"{figure} svg text")
        assert all(picture[0] <= w[0] + 1 and w[2] <= picture[2] + 1 for w in words), (figure, picture, words)
    rows = list(csv.DictReader(io.StringIO(taken(browser, "#spectrum", "CSV"))))
    above = [r for r in rows if r["number_density_hw95"] and float(r["number_density"]) > float(r["number_density_hw95"])]
    bars = boxes("#spectrum .mark-rule.role-mark line")
    assert 0 < len(above) == sum(b[3] < bottom - 2 for b in bars) < len(bars), (rows, bottom, bars)
    caption = text(browser, "#plane-chart figcaption")
    of_three = list(csv.DictReader(io.StringIO(taken(browser, "#plane-chart", "CSV"))))
    weak = sum(row["weak"] == "1" for row in of_three)
    assert 0 < weak == browser.js("[...document.querySelectorAll('#plane-chart .role-mark text')].filter((t) => t.textContent.includes('~')).length"), weak
    assert "~: weak, too few runs" in caption and "(weak)" not in caption, caption
    assert "Bars: 95 % intervals. Click a mark," in caption, caption
    assert not boxes("#plane-chart .mark-line.role-mark path"), "points of one place are joined"
    done("no mark is cut by the frame")
    alter(f"{three}.html", "narrow.html", "UPDATE spectra SET count_hw95 = count_mean / 2")
    browser.open("narrow.html")
    wait_shown(browser, 1)
    bottom, bars = boxes("#spectrum .mark-group.role-frame path.background")[0][3], boxes("#spectrum .mark-rule.role-mark line")
    assert len(bars) > 4 and all(b[3] < bottom - 2 for b in bars), (bottom, bars)
    browser.open("levels.html", "#x=grain_spacing&y=&quantity=dust_fraction")
    wait_shown(browser, 1)
    assert len(boxes("#plane-chart .mark-line.role-mark path")) == 1
    ticks = browser.js("[...document.querySelectorAll('#plane-chart .role-axis-label text')].map((t) => t.textContent)")
    assert not any(t.startswith("\u2212") for t in ticks), ticks
    done("a line joins the means of one input; the axis of a share does not go below 0")


def side_by_side(browser):
    browser.open("two.html")
    wait_shown(browser, 1)
    told = text(browser, "#compare .body")
    assert "small.db and other.db also differ in charge.energy (2000 J/m, 3000 J/m)." in told and "The same from a shell" in told, told
    assert " 44 grains (small.db), 49 grains (other.db), 3 seeds a point" in text(browser, "#made"), text(browser, "#made")
    assert "runs of each point of small.db (the choice Store shows the others)" in text(browser, "#plane-chart figcaption")
    heads = browser.js("[...document.querySelectorAll('#seeds thead th')].map((h) => h.textContent.split(':')[0])")
    assert heads == ["", "small.db", "other.db"] and " of 6 runs." in text(browser, "#seeds figcaption"), heads
    with sqlite3.connect("file:other.db?mode=ro", uri=True) as db:
        (point,) = browser.js("[...new URLSearchParams(location.hash.slice(1)).get('points').split('.').map(Number)]")
        with sqlite3.connect(f"file:{store}?mode=ro", uri=True) as own:
            same = own.execute("SELECT threshold_strain, threshold_angle FROM points WHERE point_id = ?", (point,)).fetchone()
        (mean,) = db.execute("SELECT largest_fraction_mean FROM points WHERE (threshold_strain, threshold_angle) = (?, ?)", same).fetchone()
    cell = browser.js("document.querySelector('#seeds tbody tr').cells[2].textContent")
    assert abs(float(re.match(r"[0-9.]+", cell).group()) - mean) < 0.1 * mean, (cell, mean)
    browser.size(390, 900)
    browser.until("document.querySelector('#compare .scroll').scrollWidth <= document.querySelector('#compare .scroll').clientWidth")
    assert browser.js("document.querySelector('#compare td:last-child').dataset.heading") == "other.db minus small.db"
    browser.size(1280, 900)
    browser.open("pair.html")
    wait_shown(browser, 1)
    told = text(browser, "#compare .body")
    assert "angle 2 deg, strain 2 %; angle 6 deg, strain 5 %" in told and " of two points;" in told and "small.db:4: no" not in told, told
    assert browser.js("document.querySelectorAll('#points tbody tr').length") == 1
    commands = browser.js("[...document.querySelectorAll('figure code, #compare code')].map((c) => c.textContent)")
    assert len(commands) == 4 and "clast compare small.db:1 small.db:4 --quantity largest_fraction" in commands, commands
    for command in commands:
        subprocess.run([clast, *shlex.split(command)[1:]], check=True, capture_output=True)
    browser.open("chosen.html")
    wait_shown(browser, 1)
    commands = browser.js("[...document.querySelectorAll('figure code')].map((c) => c.textContent)")
    assert len(commands) >= 3 and all("--campaign 1 --where" in c and "seed < 3" in c for c in commands), commands
    for command in commands:
        subprocess.run([clast, *shlex.split(command)[1:]], check=True, capture_output=True)
    browser.open("apart.html")
    wait_shown(browser, 1)
    told = text(browser, "#compare .body")
    assert "marked.db: no two points have the same varied inputs" in told and "The same from a shell" not in told, told
    for quantity in ("largest_fraction", "energy_input"):  # the second is no main result
        browser.open("held.html", f"#quantity={quantity}&points=1")
        wait_shown(browser, 1)
        told = text(browser, "#compare .body")
        assert browser.js("document.querySelectorAll('#compare tbody tr').length") == 2 and "of the common points;" in told and f"--quantity {quantity}" in told, told
        assert "strain 2 %, angle 6 deg" in told and "strain 5 %, angle 6 deg" in told, told
        names = browser.js("[...document.querySelectorAll('#seeds thead th')].map((h) => h.textContent.split(':')[0])")
        assert names == ["", "held.db", "small.db"], names
    done("stores side by side tell inputs that differ, and grains of each")


def equal_runs(browser):
    """All runs are 1: no run is the least, no line is drawn, and the axis of the runs stays near their value."""
    browser.open("whole.html")
    wait_shown(browser, 1)
    ticks = [float(t) for t in browser.js("[...document.querySelectorAll('#seeds .role-axis-label text')].map((t) => t.textContent)")]
    assert 0.95 in ticks and 1.05 in ticks, ticks
    assert "Lines:" not in text(browser, "#spectrum figcaption"), text(browser, "#spectrum figcaption")
    pictures = browser.js("[...document.querySelectorAll('#runs figcaption')].map((c) => c.textContent)")
    assert pictures and not any("least" in p or "largest" in p for p in pictures), pictures
    done("runs that are equal")


def of_a_study(browser):
    """Columns, rows and spacing of grains tell the levels apart in the same way: the page opens on the spacing alone."""
    browser.open("levels.html")
    wait_shown(browser, 1)
    of = lambda axis: browser.js(f"document.querySelector('#choices [name={axis}]').value")
    assert (of("x"), of("y")) == ("grain_spacing", ""), (of("x"), of("y"))
    done("a page of a study opens on one input")
    with sqlite3.connect("file:load.db?mode=ro", uri=True) as db:
        points, runs = db.execute("SELECT count(DISTINCT point_id), count(*) FROM runs WHERE study").fetchone()
    asked = open_text(browser, "load.html", "#asked")
    assert points > 0 and f"{points} points ({runs} runs) of studies and searches (--studies)" in asked, (points, runs, asked)
    assert "studies and searches" not in open_text(browser, "studied.html", "#asked")
    done("a page names the points that it leaves out")


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
    marks(browser)
    slices(browser)
    opens_on(browser)
    scenes(browser)
    side_by_side(browser)
    several(browser)
    ends(browser)
    equal_runs(browser)
    of_a_study(browser)
    assert browser.complaints == [], browser.complaints
    outside = [url for url in browser.requests if not url.startswith(("file:", "blob:", "data:", "about:"))]
    assert outside == [], outside
    done("no error in the console, no request to a network")
