#!/usr/bin/env bash
# The stability map: campaigns over extreme inputs (map/*.yaml) in one store. Each run is usable and drifts by 1 % at most or says
# so, or it is refused with a message that has a remedy. Short form: four points of each sampled campaign. Long form, all points:
#   CLAST_FULL=1 CLAST_STORE=/tmp/map.db bash tests/extremes/map.sh BUILD_FOLDER SOURCE_FOLDER
. "$(dirname "$0")/../cli/lib.bash"

full=${CLAST_FULL:-0} store=${CLAST_STORE:-map.db}
cp "$source"/tests/extremes/map/*.yaml .
campaigns=(*-*.yaml)
if [ "$full" != 1 ]; then
  sed -i 's/, points: [0-9]*/, points: 4/' "${campaigns[@]}"
  # the longest ones; a campaign of sizes up to 1e5 grains and 1e6 particles is left to the long form
  rm dem-size.yaml sph-size.yaml sph-ratio.yaml
  sed -i 's/fidelity.particles: \[.*/fidelity.particles: [60]/; s/fidelity.projectile_spacing: \[.*/fidelity.projectile_spacing: [1]/' sph-impact.yaml
  campaigns=(*-*.yaml)
fi
for file in "${campaigns[@]}"; do
  got=0
  timeout 7200 "$clast" run "$file" --store "$store" --quiet >out 2>err || got=$?
  [ "$got" -eq 0 ] || [ "$got" -eq 1 ] || fail "exit $got of $file" # 1: some runs were refused, which the table below judges
done
ok "${#campaigns[@]} campaigns in one store"

expect 0 "$clast" check "$store" # masses, sums, ranges of results
expect 0 "$clast" extremes "$store"
cat out
"$clast" extremes "$store" --json >campaigns.json
"$clast" extremes "$store" --json --why >reasons.json
"$clast" query "$store" "select state, message, energy_error from run" --json >runs.json
python - "$full" <<'PY'
import json, sys
campaigns, reasons, runs = (json.load(open(f"{name}.json")) for name in ("campaigns", "reasons", "runs"))
assert len(runs) >= (2000 if sys.argv[1] == "1" else 40), len(runs)
for c in campaigns:
    assert c["safe"] + c["warned"] + c["refused"] == c["runs"] and c["runs"] > 0, c
    assert c["given_up"] == 0, ("runs without a result", c)
    assert c["silent_drift"] == 0, ("a drift of more than 1 % without a word", c)
    assert c["largest_drift"] is None or c["largest_drift"] <= 0.01, c # no scene of the map has a wider bound
assert sum(r["runs"] for r in reasons) == sum(c["warned"] + c["refused"] for c in campaigns)
remedies = ("give ", "lower ", "raise ", "set ", "take ")
for run in runs:
    if run["state"] in ("completed", "end-time"):
        continue
    assert any(word in run["message"] for word in remedies), ("no remedy", run)
    assert run["state"] == "invalid" or " s" in run["message"] and ("grain " in run["message"] or "article " in run["message"]), run
print(len(runs), "runs judged")
PY
ok "every run is usable within its bound, or says what to do"
done_after 4
