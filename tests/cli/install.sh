#!/usr/bin/env bash
# What `cmake --install` and CPack install, and the recipes for other places. CLAST_FULL=1 (as root, with debootstrap and a
# network) also installs the Debian package into a clean Debian 12 and runs a campaign there.
. "$(dirname "$0")/lib.bash"
packaging=$source/campaign/packaging

# ---- cmake --install: the program, its page, completion, examples, schemas, the Python module
expect 0 cmake --install "$build" --prefix "$work/prefix"
for file in bin/clast share/man/man1/clast.1 share/bash-completion/completions/clast share/zsh/site-functions/_clast \
  share/fish/vendor_completions.d/clast.fish share/clast/examples/demo.yaml share/clast/examples/slurm.sh \
  share/clast/schemas/campaign.schema.json share/clast/schemas/results.sql share/clast/python/clast.py \
  share/doc/clast/copyright; do
  [ -s "prefix/$file" ] || fail "not installed: $file"
done
ok "installed files"
expect 0 prefix/bin/clast plan prefix/share/clast/examples/demo.yaml --no-trial
# completion: each script is the program's, and the program completes for it
for script in bash:share/bash-completion/completions/clast zsh:share/zsh/site-functions/_clast \
  fish:share/fish/vendor_completions.d/clast.fish; do
  "$clast" completion "${script%%:*}" | cmp - "prefix/${script#*:}" || fail "script for ${script%%:*}"
  grep -q "clast completion ${script%%:*} -- " "prefix/${script#*:}" || fail "${script%%:*} calls another completion"
done
expect 0 bash -n prefix/share/bash-completion/completions/clast
export PATH=$work/prefix/bin:$PATH
[ "$(clast completion bash -- run x --set "" | wc -l)" -gt 100 ] || fail "inputs after --set"
for shell in bash zsh fish; do
  same "$(clast completion $shell -- run x --set contact.fri)" contact.friction= "an input for $shell"
  same "$(clast completion $shell -- explain target.material.weibull.m)" target.material.weibull.m "a path for $shell"
  same "$(clast completion $shell -- run x --store "")$(clast completion $shell -- elephant "")" "" "names of files for $shell"
done
same "$(clast completion bash -- run x --dry)" --dry-run "an option for bash"
same "$(clast completion zsh -- run x --dry)" "--dry-run:Print what would be done, like \`clast plan\`, and stop" "an option for zsh"
same "$(clast completion fish -- che)" "$(printf 'check\tcheck a store: integrity, sums, orphaned rows, missing files')" "a command for fish"
if command -v fish >/dev/null; then # no package of the tests
  fish -c ". prefix/share/fish/vendor_completions.d/clast.fish; complete -C 'clast run x --set contact.fri'" | grep -q "^contact.friction=" ||
    fail "fish does not complete contact.friction="
fi
ok "completion of three shells"

# ---- the Debian package; sanitizers' libraries are no part of Debian's packages
if [ "$sanitized" -eq 0 ]; then
  (cd "$build" && cpack -G DEB -B "$work/package") >out 2>err || fail "cpack"
  package=$(echo package/*.deb)
  dpkg-deb -f "$package" Depends >depends
  for library in libc6 libfyaml0 libhdf5 libgsl27 libsqlite3-0 libmicrohttpd12 libjansson4 libnettle8 libcairo2 libopenmpi3; do
    grep -q "$library" depends || fail "the package does not depend on $library: $(cat depends)"
  done
  dpkg-deb -x "$package" unpacked
  same "$(cd unpacked/usr && find . -type f | sort | md5sum)" "$(cd prefix && find . -type f | sort | md5sum)" "files of the package"
  expect 0 unpacked/usr/bin/clast version
  same "$(dpkg-deb -f "$package" Version)" "$("$clast" version | sed -nE '1s/^clast ([0-9.]+).*/\1/p')" "version of the package"
  if [ -n "${CLAST_FULL:-}" ] && [ "$(id -u)" -eq 0 ]; then
    expect 0 debootstrap --variant=minbase bookworm "$work/debian"
    cp "$package" debian/tmp/clast.deb
    expect 0 chroot debian sh -c 'apt-get update -q && DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends /tmp/clast.deb'
    cat >debian/tmp/try.sh <<'TRY'
set -eu
cd /tmp
clast version
for example in /usr/share/clast/examples/*.yaml; do clast plan "$example" --no-trial >/dev/null; done
clast run /usr/share/clast/examples/demo.yaml --seeds 2 --quiet
clast check demo.db
clast schema campaign | cmp - /usr/share/clast/schemas/campaign.schema.json
bash -c '. /usr/share/bash-completion/completions/clast; COMP_WORDS=(clast run x --set contact.fri); COMP_CWORD=4; _clast
  [ "${COMPREPLY[*]}" = contact.friction= ]'
grep -q "^.SH" /usr/share/man/man1/clast.1
apt-get purge -y -q clast >/dev/null
[ -z "$(find /usr -name "*clast*")" ] || { echo "left behind:"; find /usr -name "*clast*"; exit 1; }
TRY
    expect 0 chroot debian sh /tmp/try.sh
    checks=$((checks - 3))
  fi
else
  checks=$((checks + 3))
fi

# ---- recipes: one list of packages, in setup.sh; the others have no names of their own
packages=$(sed -n '/^packages="/,/"$/p' "$source/setup.sh" | tr -d '"' | sed 's/^packages=//')
expect 0 python - "$packaging" $packages <<'PY'
import ast, re, sys
folder, listed = sys.argv[1], set(sys.argv[2:])
recipe = open(f"{folder}/spack/packages/clast/package.py").read()
tree = ast.parse(recipe)
table = ast.literal_eval(next(node.value for node in tree.body if isinstance(node, ast.Assign) and node.targets[0].id == "DEBIAN"))
needed = {re.split(r"[@+]", ast.literal_eval(node.args[0]))[0] for node in ast.walk(tree)
          if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "depends_on"}
tools = {"build-essential", "openmpi-bin", "clang-format", "python3", "python3-jsonschema", "python3-ruamel.yaml", "sqlite3"}
assert set(table) == listed - tools, (set(table) ^ (listed - tools))
assert set(table.values()) == needed - {"c"}, set(table.values()) ^ (needed - {"c"})
for name in ("Dockerfile", "clast.def"):
    text = open(f"{folder}/{name}").read()
    code = "\n".join(line for line in text.splitlines() if not line.startswith("#"))
    assert "setup.sh deb /package" in code and not re.search(r"\blib\w+-dev\b", code), name
    installed = set(re.findall(r"gnuplot-nox|openmpi-bin", code))
    assert installed == {"gnuplot-nox", "openmpi-bin"} <= listed, (name, installed)
    assert not re.search(r"^\s*FROM (?!debian:12)|^From: (?!debian:12)", code, re.M), name
steps = [line.split()[0] for line in open(f"{folder}/Dockerfile") if line.strip() and line[0] not in "# \n"]
assert set(steps) <= {"FROM", "COPY", "RUN", "WORKDIR", "ENTRYPOINT", "CMD"}, steps
sections = re.findall(r"^%(\w+)", open(f"{folder}/clast.def").read(), re.M)
assert sections == ["files", "post", "files", "post", "runscript", "test"], sections
PY
ok "recipes name the packages of setup.sh"
done_after 22
