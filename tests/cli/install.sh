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
  share/clast/templates/lines.gp share/doc/clast/copyright; do
  [ -s "prefix/$file" ] || fail "not installed: $file"
done
ok "installed files"
expect 0 prefix/bin/clast plan prefix/share/clast/examples/demo.yaml --no-trial
# every command and option is in the scripts of all three shells
for command in $("$clast" completion bash | sed -n 's/.*compgen -W "\(.*\) --help --version".*/\1/p'); do
  grep -q "^complete -c clast -n __fish_use_subcommand -f -a $command " prefix/share/fish/vendor_completions.d/clast.fish ||
    fail "fish lacks $command"
  grep -q "^  $command) _arguments" prefix/share/zsh/site-functions/_clast || fail "zsh lacks $command"
  for option in $("$clast" completion bash | sed -n "s/^    $command) options=\"\(.*\)\" ;;/\1/p"); do
    [ "$option" != --help ] || continue
    grep -q "__fish_seen_subcommand_from $command' -l ${option#--} " prefix/share/fish/vendor_completions.d/clast.fish ||
      fail "fish lacks $command $option"
    grep "^  $command) _arguments" prefix/share/zsh/site-functions/_clast | grep -qE -- "$option(=|\[)" ||
      fail "zsh lacks $command $option"
  done
done
expect 0 bash -n prefix/share/bash-completion/completions/clast
# inputs after --set: zsh and fish have the list of bash
inputs=$(sed -n 's/^_clast_inputs="\(.*\)"/\1/p' prefix/share/bash-completion/completions/clast)
[ "$(echo "$inputs" | wc -w)" -gt 100 ] || fail "bash knows $(echo "$inputs" | wc -w) inputs"
[ "$(sed -n 's/^inputs=(\(.*\))/\1/p' prefix/share/zsh/site-functions/_clast)" = "$inputs" ] || fail "inputs for zsh"
[ "$(sed -n 's/^set -g __clast_inputs //p' prefix/share/fish/vendor_completions.d/clast.fish)" = "$inputs" ] || fail "inputs for fish"
for command in run simulate; do
  grep "^  $command) _arguments" prefix/share/zsh/site-functions/_clast | grep -qF "PATH=VALUE:{compadd -S = -a inputs}'" ||
    fail "zsh: no inputs after $command --set"
  grep -qF "from $command' -l set -s s -x -a '\$__clast_inputs='" prefix/share/fish/vendor_completions.d/clast.fish ||
    fail "fish: no inputs after $command --set"
done
if command -v fish >/dev/null; then # no package of the tests
  fish -c ". prefix/share/fish/vendor_completions.d/clast.fish; complete -C 'clast run x --set contact.fri'" | grep -q "^contact.friction=" ||
    fail "fish does not complete contact.friction="
fi
! grep -nE "^[^#]*'[^']*'[^']*'$" prefix/share/fish/vendor_completions.d/clast.fish | grep -vE -- " -d ('|Input$)" || fail "fish: quotes"
ok "completion of three shells"

# ---- the Debian package; sanitizers' libraries are no part of Debian's packages
if [ "$sanitized" -eq 0 ]; then
  (cd "$build" && cpack -G DEB -B "$work/package") >out 2>err || fail "cpack"
  package=$(echo package/*.deb)
  dpkg-deb -f "$package" Depends >depends
  for library in libc6 libfyaml0 libhdf5 libgsl27 libsqlite3-0 libmicrohttpd12 libjansson4 libcairo2 libopenmpi3; do
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
done_after 10
