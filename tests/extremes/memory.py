"""A small campaign and a run of each engine, with memory refused once at every place that allocates.

memory.py BUILD_FOLDER ALLOCATOR: prints a line per command, and fails with the places that ended badly. A place ends well
if the program says that memory was refused (exit 71), or that the same command resumes (exit 75), or if it gives what it
gives with memory (a run that is lost is computed again). It must not end by a signal, hang, or leave a process or a damaged store behind.
CLAST_FULL=1: all places, else a sample of them. CLAST_LIBRARIES=1: also where SQLite, HDF5 and other libraries ask for
memory; these cannot all bear it.
"""
import concurrent.futures
import os
import random
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time

build, allocator = (os.path.abspath(path) for path in sys.argv[1:3])
clast = os.path.join(build, 'clast')
full = 'CLAST_FULL' in os.environ
watched = {'LD_PRELOAD': allocator, 'ALLOCATIONS': 'table'}
if 'CLAST_LIBRARIES' in os.environ:
    watched['ALLOCATIONS_LIBRARIES'] = '1'
SAMPLE, SEED, HANG_S = 12, 28, 60  # places of a command; of the sample; far more than any of the commands takes
CAMPAIGN = '''name: tiny
scene: disc-explosion
set: {body.diameter: 8 cm, charge.energy: 1e4 J/m, stop.end_time: 1 ms}
vary: {threshold.strain: [2 %, 5 %]}
seeds: {per_point: 2}
store: tiny.db
'''
RUN = [clast, 'run', 'tiny.yaml', '-j', '2', '--quiet']
COMMANDS = {
    'run': RUN,
    'dem': [clast, 'simulate', 'disc-explosion', '--set', 'body.diameter=8 cm', '--set', 'stop.end_time=1 ms', '--fields',
            'fields.hdf', '--quiet', '--csv'],
    'sph': [clast, 'simulate', 'basalt-sphere', '--set', 'fidelity.particles=300', '--set', 'stop.end_time=4 us',
            '--fields', 'fields.hdf', '--quiet', '--csv'],
}


def start(command, folder, **environment):
    """Runs it to its end. Returns exit code (a signal: below 0; None: it hung), stdout, stderr, and whether a process
    of it is left."""
    process = subprocess.Popen(command, cwd=folder, env={**os.environ, **environment}, stdin=subprocess.DEVNULL,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True, text=True)
    code = None
    try:
        out, err = process.communicate(timeout=HANG_S)
        code = process.returncode
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        out, err = process.communicate()
    end = time.time() + 10  # a slot ends by itself soon after its manager
    while True:
        try:
            os.killpg(process.pid, 0 if time.time() < end else signal.SIGKILL)
        except ProcessLookupError:
            return code, out, err, False
        if time.time() >= end:
            return code, out, err, True
        time.sleep(0.05)


def new_folder(scratch):
    folder = tempfile.mkdtemp(dir=scratch)
    with open(os.path.join(folder, 'tiny.yaml'), 'w') as file:
        file.write(CAMPAIGN)
    return folder


def bits(folder):
    """The content of the campaign's store, the same for any way of computing it."""
    code, _, err, _ = start([clast, 'export', 'tiny.db', 'bits', '--bits'], folder)
    if code != 0:
        return err
    with open(os.path.join(folder, 'bits')) as file:
        return file.read()


def wrong(code, out, err, left, usual):
    """What is wrong with the end of a command, or None."""
    if left:
        return 'leaves a process behind'
    if code is None:
        return 'hangs'
    if code == 75 and 'the same command resumes' in ' '.join(err.split()):  # lines end at column 100
        return None  # no slot could be made
    if code not in (0, 71):
        return f'exit {code}'
    if code == 71 and 'memory' not in err:
        return 'exit 71 without a word on memory'
    if code == 0 and out != usual:
        return 'exit 0 with another result'
    return None


def wrong_store(folder, usual_bits):
    """What is wrong with the store of a campaign, or None. Runs the campaign to its end. The store may not exist. It may
    be an empty file: the program ended before its first transaction, and check rightly refuses such a file."""
    store = os.path.join(folder, 'tiny.db')
    if os.path.exists(store) and os.path.getsize(store) > 0:
        code, out, err, _ = start([clast, 'check', 'tiny.db'], folder)
        if code != 0:
            return f'clast check: {out} {err}'
    code, _, err, _ = start(RUN, folder)
    if code != 0:
        return f'the next run: exit {code}: {err}'
    return None if bits(folder) == usual_bits else 'the next run ends with other results'


def try_place(name, key, usual, usual_bits, scratch):
    folder = new_folder(scratch)
    command = COMMANDS[name]
    code, out, err, left = start(command, folder, **watched, ALLOCATIONS_REFUSE=f'{key:x}')
    with open(os.path.join(folder, 'table'), 'rb') as file:
        refused = struct.unpack('Q', file.read(8))[0] > 0
    trouble = wrong(code, out, err, left, usual)
    if not trouble and name == 'run':
        trouble = wrong_store(folder, usual_bits)
    shutil.rmtree(folder)
    return refused, code, trouble, err


def places(table):
    """[key, addresses, library] of all places."""
    with open(table, 'rb') as file:
        content = file.read()
    found = []
    for at in range(8, len(content) - 63, 64):
        key, *frames = struct.unpack_from('4Q', content, at)
        if key:
            found.append((key, [frame for frame in frames if frame], content[at + 32:at + 64].split(b'\0')[0].decode()))
    return sorted(found)


def where(frames):
    """Functions and lines, or addresses where the program has no names of lines. A return address is behind its call."""
    lines = subprocess.run(['addr2line', '-fse', clast] + [f'{frame - 1:x}' for frame in frames], capture_output=True,
                           text=True).stdout.split('\n')
    return ' < '.join(f'{function} ({line})' for function, line in zip(lines[::2], lines[1::2]))


def walk(name, scratch):
    """All places of a command. Returns the number of those that ended badly."""
    folder = new_folder(scratch)
    code, usual, err, _ = start(COMMANDS[name], folder, **watched)
    assert code == 0, f'{name}: exit {code}: {err}'
    usual_bits = bits(folder) if name == 'run' else None
    found = places(os.path.join(folder, 'table'))
    chosen = found if full else random.Random(SEED).sample(found, min(SAMPLE, len(found)))
    began, reached, ends, bad = time.time(), 0, {}, 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = pool.map(lambda place: try_place(name, place[0], usual, usual_bits, scratch), chosen)
        for (key, frames, library), (refused, code, trouble, err) in zip(chosen, results):
            reached += refused
            ends[code] = ends.get(code, 0) + refused
            if trouble:
                bad += 1
                print(f'BAD {name} {key:x} {library} {trouble}\n    {where(frames)}\n    {err.strip()[-600:]}')
    print(f'{name}: {len(found)} places, {len(chosen)} tried, {reached} reached, ends {ends}, {bad} bad, '
          f'{time.time() - began:.1f} s', flush=True)
    assert reached > 0.8 * len(chosen), 'most places must be met again'
    return bad


with tempfile.TemporaryDirectory(dir=build) as scratch:
    bad = sum(walk(name, scratch) for name in (sys.argv[3:] or COMMANDS))
sys.exit(bad > 0)
