// The plane of two inputs, coloured by a quantity; or a line over one input. Cells are chosen by a click or a brush, or
// in the table of points.
import {body, element, fill, select, table} from './elements.js';
import {COLOURS, NUMBER, draw, logAxis, nothing, scale, wrapped} from './chart.js';
import * as questions from './questions.js';
import {changed, chosenPoints, drawnPoints, state, store} from './state.js';
import {interval} from './statistics.js';
import {ask, exponents, has, newest} from './stores.js';
import {inUnit, label, marked, number, onlyOf, plural, rangeOf, fileOf, withInterval} from './words.js';

const MOST_CELLS = 40; // values on an axis that are drawn as rows and columns; more are places on a scale
const MOST_LINES = 8; // of `clast plot`
const NONE = 'does not apply'; // of a value

function statistics(from, quantity) {
  if (quantity === 'beta') return exponents(from);
  const range = rangeOf(state.stores, quantity);
  const rows = from.quantities.main.includes(quantity) ? ask(from, questions.mainStatistics(quantity))
    : has(from, 'means') ? ask(from, questions.otherStatistics, {quantity}) : ask(from, questions.statisticsOfRuns(quantity));
  const withheld = new Map(doubtsOf(from, quantity).map((row) => [row.point_id, row.withheld]));
  const values = (row) => row.n - (from.quantities.main.includes(quantity) ? withheld.get(row.point_id) ?? 0 : 0);
  return newest(rows.map((row) => ({...row, ...interval(row.mean, row.sd, values(row), range)})));
}

function doubtsOf(from, quantity) {
  if (has(from, 'doubt')) return ask(from, questions.doubts, {quantity});
  return from.runColumns.has('warnings') ? ask(from, questions.doubtsOfRuns(from.doubtful)) : [];
}

const wordsOf = (doubt) => [...new Set(doubt?.words.split(/[, ]+/) ?? [])];
const doubtText = ({doubt, n}) => (doubt ? `${doubt.doubtful} of ${plural(n ?? 0, 'run')}: ${wordsOf(doubt).join(', ')}` : 'none');

let told = new Set(); // words that the caption of the plane explains; the captions below it name them only

// What the marks of these cells mean: how many runs, which conditions they break, and what to do.
export function doubtSentence(parts, quantity = state.quantity, inPlane = false) { // parts: [[store, cells], ...]
  const rows = parts.flatMap(([, cells]) => cells), doubtful = rows.filter((row) => row.doubt);
  if (doubtful.length === 0) return '';
  const result = ` ${quantity === 'beta' ? 'mean_fragment_mass' : quantity.replace(/^result_[^_]+_/, '')} `;
  const known = parts.flatMap(([from]) => (has(from, 'doubt_word') ? ask(from, questions.sentences) : [])).filter(({results}) => results === null || results.includes(result));
  const sentences = new Map(known.map((row) => [row.word, `${row.withheld ? ' (withholds the value)' : ''}: ${row.sentence}`]));
  const sum = (of) => of.reduce((total, count) => total + (count ?? 0), 0);
  const words = [...new Set(doubtful.flatMap((row) => wordsOf(row.doubt)))];
  const above = words.filter((word) => told.has(word)), below = words.filter((word) => !told.has(word));
  if (inPlane) told = new Set(words);
  return ` !: in doubt, ${sum(doubtful.map((row) => row.doubt.doubtful))} of ${sum(rows.map((row) => row.n))} runs${above.length ? `: ${above.join(', ')} (explained above)` : ''}. ` +
    below.map((word) => `${word}${sentences.get(word) ?? `: clast explain ${word}`}.`).join(' ');
}

// Every point with the mean of the quantity, the half width of its interval over seeds, and the error that the
// resolution leaves.
export function cells(from, quantity) {
  const known = new Map(statistics(from, quantity).map((row) => [row.point_id, row]));
  const studied = has(from, 'resolution')
    ? new Map(ask(from, questions.resolution, {quantity}).map((row) => [row.point_id, row])) : new Map();
  const modes = has(from, 'modes') ? new Map(ask(from, questions.modes, {quantity}).map((row) => [row.point_id, row])) : new Map();
  const doubts = new Map(doubtsOf(from, quantity).map((row) => [row.point_id, row]));
  const judged = has(from, 'modes') && quantity !== 'beta'; // not on whole stores, and an exponent belongs to all runs
  const enough = Number(from.facts.modes_runs); // of fewer, the test finds chance more often than modes
  return from.points.map((point) => {
    const {mean = null, hw95 = null, low95 = null, high95 = null, weak = null, untold = null} = known.get(point.point_id) ?? {};
    const {half_width: resolution = null, verdict = null} = studied.get(point.point_id) ?? {};
    return {...point, mean, hw95, low95, high95, weak, untold, resolution, verdict, modes: modes.get(point.point_id) ?? null, judged: judged && point.n >= enough, doubt: doubts.get(point.point_id) ?? null};
  });
}

function placeOf(column, value) {
  if (value === null || value === undefined) return NONE;
  return typeof value === 'number' ? Number(inUnit(state.stores, column, value).toPrecision(7)) : String(value);
}

const numbers = (values) => (scale(values).type === 'log' ? logAxis(values) : {labelExpr: NUMBER});

function axisOf(column, rows, title) {
  const values = [...new Set(rows.map((row) => row[column]))];
  const numeric = values.every((value) => typeof value === 'number');
  const sampled = values.length > 12 && values.length === rows.length; // each point has a value of its own: no grid
  if (numeric && (sampled || values.length > MOST_CELLS)) return {discrete: false, encoding: {field: column, type: 'quantitative', scale: scale(values), title, axis: numbers(values)}};
  const order = values.slice().sort(ascending);
  return {discrete: true, encoding: {field: column, type: 'ordinal', sort: order, title, axis: {labelAngle: 0, labelExpr: NUMBER}}};
}

function tooltip(columns, title) {
  return [{field: 'point_id', title: 'point'}, ...columns.map(([field, name]) => ({field, title: name})),
    {field: 'shown', title}, {field: 'n', title: 'runs'}, {field: 'resolutionText', title: 'resolution'}, {field: 'modesText', title: 'modes'},
    {field: 'doubtText', title: 'in doubt'}];
}

// What finer settings may change, as far as clast converge knows.
function resolutionText({resolution, verdict}) {
  if (resolution === null) return 'not studied';
  if (verdict === 'no-difference') return 'no difference seen';
  return `${verdict === 'known' ? '±' : '>='} ${number(resolution, 2)}`;
}

// Two modes mean that a mean tells little: some runs do one thing, the others another.
export const modesText = ({modes, judged}) => (modes ? `two: ${number(modes.lower_mode, 3)} and ${number(modes.upper_mode, 3)}, the upper one in ` +
  `${number(100 * modes.upper_share, 2)} % of the runs (${number(100 * modes.upper_low, 2)} to ${number(100 * modes.upper_high, 2)} %)` : judged ? 'not two' : 'not judged');

// Where several points share a cell of the map, it shows one value of each other input: that of a chosen point at first.
// Empty: every point has a cell of its own.
function slice() {
  if (!state.y) return {};
  const {points, varied} = store(), cellOf = (point) => JSON.stringify([point[state.x], point[state.y]]);
  if (new Set(points.map(cellOf)).size === points.length) return {};
  const others = varied.map((axis) => axis.column_name).filter((column) => column !== state.x && column !== state.y);
  const first = chosenPoints()[0] ?? points[0];
  return Object.fromEntries(others.map((column) => [column,
    points.some((point) => point[column] === state.at[column]) ? state.at[column] : first[column] ?? null]));
}

const inSlice = (row, at) => Object.entries(at).every(([column, value]) => (row[column] ?? null) === value);
const sliceText = (at) => Object.entries(at).map(([column, value]) => `${label(state.stores, column)} = ${valueText(column, value)}`).join(', ');
const valueText = (column, value) => (value === null ? 'none' : number(placeOf(column, value), 7));

function data(quantity) {
  return cells(store(), quantity).map((cell) => ({
    ...cell,
    [state.x]: placeOf(state.x, cell[state.x]),
    ...(state.y ? {[state.y]: placeOf(state.y, cell[state.y])} : {}),
    shown: cell.untold ? `- (${cell.untold})` : marked(withInterval(cell), cell.doubt, cell.n),
    told: cell.hw95 === null ? number(cell.mean, 3) : withInterval({...cell, weak: false}),
    mark: cell.doubt ? ' !' : '',
    doubtText: doubtText(cell),
    low: cell.low95 ?? cell.mean - cell.hw95,
    high: cell.high95 ?? cell.mean + cell.hw95,
    resolutionText: resolutionText(cell),
    modesText: modesText(cell),
    twoModes: cell.modes !== null,
  }));
}

const PARAMETERS = [{name: 'chosen', value: []}]; // points
const isChosen = 'indexof(chosen, datum.point_id) >= 0';

// What a cell may hold, the widest text first; the last has the interval in a line of its own.
function cellTexts(row) {
  if (row.mean === null) return ['-', '-', '-'];
  const told = row.told + (row.weak ? '~' : '') + row.mark;
  return [`${told}  n=${row.n}`, told, told.replace(/ (?=[±(])/, '\n')];
}

function planeSpec(rows, title) {
  const x = axisOf(state.x, rows, label(state.stores, state.x)), y = axisOf(state.y, rows, label(state.stores, state.y));
  const grid = x.discrete && y.discrete;
  const flip = y.discrete ? {...y.encoding, sort: y.encoding.sort.slice().reverse()} : y.encoding;
  const columns = grid ? new Set(rows.map((row) => row[state.x])).size : 99;
  const middle = rows.map((row) => row.mean).filter((mean) => mean !== null).sort((a, b) => a - b);
  const half = ((middle[0] ?? 0) + (middle[middle.length - 1] ?? 0)) / 2;
  const place = {x: x.encoding, y: flip};
  const room = (document.getElementById('plane-chart').clientWidth - 90) / columns; // pixels of a cell
  const several = rows.length > new Set(rows.map((row) => JSON.stringify([row[state.x], row[state.y]]))).size;
  const layers = [{
    params: [{name: 'brush', select: {type: 'interval', encodings: ['x', 'y']}}],
    mark: grid ? {type: 'rect', cursor: 'pointer'} : {type: 'point', filled: true, size: 120, opacity: 1, cursor: 'pointer'},
    encoding: {...place,
      color: {field: 'mean', type: 'quantitative', title: wrapped(title, document.getElementById('plane-chart')), scale: {scheme: 'cividis', zero: false}, legend: {orient: 'top', gradientLength: 220, titleLimit: 0, tickCount: 4, labelOverlap: 'greedy'}},
      ...(grid ? {stroke: {value: 'white'}} : {stroke: {condition: {test: isChosen, value: '#D40000'}, value: '#606060'}, strokeWidth: {condition: {test: isChosen, value: 4}, value: 1}}),
      tooltip: tooltip([[state.x, label(state.stores, state.x)], [state.y, label(state.stores, state.y)]], title)},
  }];
  if (grid) // over the white lines of the neighbours
    layers.push({transform: [{filter: isChosen}], mark: {type: 'rect', filled: false, stroke: '#D40000', strokeWidth: 4, tooltip: null}, encoding: place});
  const texts = rows.map(cellTexts), LETTER = 7.5; // pixels
  const fitting = [0, 1, 2].find((k) => texts.every((text) => text[k].split('\n').every((line) => line.length * LETTER <= room))); // undefined: the colour alone
  if (grid && fitting !== undefined && !several)
    layers.push({mark: {type: 'text', baseline: 'middle', lineBreak: '\n', dy: fitting === 2 ? -7 : 0, tooltip: null, fontSize: 12},
      encoding: {...place, text: {field: 'cell'}, color: {condition: {test: `datum.mean === null || datum.mean > ${half}`, value: 'black'}, value: 'white'}}});
  if (rows.some((row) => row.twoModes))
    layers.push({transform: [{filter: 'datum.twoModes'}], mark: {type: 'text', text: room >= 90 ? '◆ two modes' : '◆', dy: fitting === 2 ? 22 : 15, fontSize: 12, tooltip: null},
      encoding: {...place, color: {condition: {test: `datum.mean > ${half}`, value: 'black'}, value: 'white'}}});
  const height = y.discrete ? Math.min(560, Math.max(300, 130 + 40 * new Set(rows.map((row) => row[state.y])).size)) : 420;
  return {params: PARAMETERS, data: {values: rows.map((row, i) => ({...row, cell: texts[i][fitting ?? 2]}))}, height, layer: layers};
}

const ascending = (a, b) => (typeof a === 'number' && typeof b === 'number' ? a - b : String(a).localeCompare(String(b)));

function lineSpec(known, title) {
  const rows = known.map((row) => ({...row, cell: (row.weak ? '~' : '') + row.mark})).sort((a, b) => ascending(a[state.x], b[state.x]));
  const x = axisOf(state.x, rows, label(state.stores, state.x));
  const numeric = rows.every((row) => typeof row[state.x] === 'number');
  const values = rows.map((row) => row[state.x]);
  const place = numeric ? {field: state.x, type: 'quantitative', title: x.encoding.title, scale: scale(values), axis: numbers(values)} : x.encoding;
  const low = Math.min(...rows.map((row) => row.low)), high = Math.max(...rows.map((row) => row.high)), room = 0.05 * (high - low);
  const {least, most} = rangeOf(state.stores, state.quantity); // a share is no less than 0
  const y = {field: 'mean', type: 'quantitative', title, scale: {zero: false, ...(room > 0 && {domain: [Math.max(low - room, least ?? -Infinity), Math.min(high + room, most ?? Infinity)]})}};
  const joined = new Set(values).size === rows.length; // as by `clast plot`
  return {params: PARAMETERS, data: {values: rows}, height: 340, layer: [
    ...(joined ? [{mark: {type: 'line', color: COLOURS[0], strokeWidth: 1.5, tooltip: null}, encoding: {x: place, y, order: {value: null}}}] : []),
    {mark: {type: 'rule', strokeWidth: 1.5}, encoding: {x: place, y: {...y, field: 'low'}, y2: {field: 'high'}}},
    {params: [{name: 'brush', select: {type: 'interval', encodings: ['x']}}],
      mark: {type: 'point', filled: true, size: 110, cursor: 'pointer', color: COLOURS[0]},
      encoding: {x: place, y, stroke: {condition: {test: isChosen, value: '#D40000'}, value: 'white'},
        strokeWidth: {condition: {test: isChosen, value: 4}, value: 1},
        tooltip: tooltip([[state.x, label(state.stores, state.x)]], title)}},
    {mark: {type: 'text', align: 'left', dx: 7, dy: -9, fontSize: 14, fontWeight: 'bold', tooltip: null}, encoding: {x: place, y, text: {field: 'cell'}}},
    {transform: [{filter: 'datum.twoModes'}], mark: {type: 'text', text: '◆ two modes', dy: -14, tooltip: null}, encoding: {x: place, y}}]};
}

// A brush over cells lists values, one over a scale has two ends.
function within(place, row) {
  return Object.entries(place).every(([column, range]) => {
    if (!Array.isArray(range)) return true;
    const value = row[column];
    const ends = range.length === 2 && range.every((end) => typeof end === 'number') && !axisOf(column, plane.shown, '').discrete;
    const inLine = state.y === '' || state.y === null;
    if (ends || (inLine && range.length === 2 && typeof value === 'number')) return value >= Math.min(...range) && value <= Math.max(...range);
    return range.includes(value);
  });
}

export function choose(ids) {
  state.chosen = new Set(ids);
  changed('chosen');
}

const plane = {view: null, rows: [], shown: [], waiting: 0}; // shown: the rows that the chart has

function listen(view) {
  view.addSignalListener('brush', (_, place) => {
    clearTimeout(plane.waiting);
    plane.waiting = setTimeout(() => {
      if (place && Object.keys(place).length) choose(plane.shown.filter((row) => within(place, row)).map((row) => row.point_id));
    }, 80);
  });
  view.addEventListener('click', (_, item) => {
    const id = item?.datum?.point_id;
    if (id === undefined || item.mark.marktype === 'line') return; // a line has the first point's number
    const ids = new Set(state.chosen);
    if (!ids.delete(id)) ids.add(id);
    choose(ids);
  });
}

function commandOf(at) {
  const quantity = state.quantity === 'beta' ? 'beta' : state.quantity;
  const from = fileOf(store());
  if (!state.x) return `clast stats ${from} --quantity ${quantity}${store().points.length === 1 ? ` --point ${store().points[0].point_id}` : ''}${onlyOf(store())}`;
  const sql = Object.entries(at).map(([column, value]) => `${column} IS ${typeof value === 'string' ? `'${value.replace(/'/g, "''")}'` : value}`).join(' AND ');
  const {points} = store(), where = points.length === 1 ? ` --point ${points[0].point_id}${onlyOf(store())}` : onlyOf(store(), sql);
  const has = (column) => (row) => row[column] !== NONE, is = (column) => (row) => typeof row[column] === 'number';
  if (state.y && plane.shown.filter(is(state.x)).some(is(state.y))) return `clast map ${from} map.png -x ${state.x} -y ${state.y} -Q ${quantity}${where}`;
  const lines = new Set(plane.shown.filter(has(state.x)).map((row) => row[state.y]));
  if (lines.size > 0 && lines.size <= MOST_LINES) return `clast plot ${from} plot.png -x ${state.x}${state.y ? ` --by ${state.y}` : ''} -Q ${quantity}${where}`;
  return quantity === 'beta' ? `clast estimates ${from}${where}` : `clast stats ${from} --by ${state.x}${state.y ? `,${state.y}` : ''} -Q ${quantity}${where}`;
}

const WHAT_ERRORS = '± in the table of points is the half width of the 95 % interval over seeds. It does not hold the error of the resolution';
function resolutionSentence(rows, marked) { // marked: ~ stands in the chart
  const studied = rows.filter((row) => row.resolution !== null), weak = !rows.some((row) => row.weak) ? '' : marked ? ' ~: weak, too few runs for the interval.' : ' (weak): too few runs for the interval.';
  if (studied.length === 0) return `${WHAT_ERRORS}, which was not studied (clast converge).${weak}`;
  const count = (verdict) => studied.filter((row) => row.verdict === verdict).length, diverging = count('diverges'), open = count('at-least');
  const others = studied.filter((row) => row.verdict !== 'diverges'), most = (others.length ? others : studied).reduce((one, row) => (row.resolution > one.resolution ? row : one));
  const unbounded = [diverging && `at ${diverging} it does not converge`, open && `at ${open} no limit is seen`].filter(Boolean);
  const found = unbounded.length && studied.length > 1 ? `${unbounded.join(', ')}, and the largest error${diverging && others.length ? ' of the others' : ''} is ` : most.verdict === 'known' ? 'up to ' : '';
  return `${WHAT_ERRORS}; that was studied at ${plural(studied.length, 'point')}: ${found}${resolutionText(open && most.verdict !== 'diverges' ? {...most, verdict: 'at-least'} : most)}.${weak}`;
}

// Inputs that are no axis and change from dot to dot.
function behind(at) {
  const others = store().varied.map((axis) => axis.column_name).filter((column) => column !== state.x && column !== state.y && !(column in at));
  return others.length ? ` From point to point ${others.map((column) => label(state.stores, column)).join(', ')} ${others.length > 1 ? 'change' : 'changes'}, too (clast sensitivity ranks the inputs).` : '';
}

// How much of the scatter between points one input explains: groups of its values, at most four of many values.
export function effect(rows, column) {
  const known = rows.filter((row) => row.mean !== null), values = [...new Set(known.map((row) => row[column]))];
  const sorted = [...known].sort((a, b) => (a[column] < b[column] ? -1 : a[column] > b[column] ? 1 : 0)), groups = new Map();
  sorted.forEach((row, i) => {
    const group = values.length > 6 ? Math.floor((4 * i) / sorted.length) : row[column];
    if (!groups.has(group)) groups.set(group, []);
    groups.get(group).push(row.mean);
  });
  const squares = (list) => {
    const mean = list.reduce((a, b) => a + b, 0) / list.length;
    return list.reduce((sum, value) => sum + (value - mean) ** 2, 0);
  };
  const within = [...groups.values()].reduce((sum, list) => sum + squares(list), 0) / Math.max(1, known.length - groups.size);
  return 1 - within / (squares(known.map((row) => row.mean)) / Math.max(1, known.length - 1) || 1);
}

export async function showPlane() {
  const figure = document.getElementById('plane-chart');
  const title = label(state.stores, state.quantity);
  const at = slice();
  told = new Set();
  plane.rows = data(state.quantity);
  const rows = (plane.shown = plane.rows.filter((row) => inSlice(row, at)));
  const known = rows.filter((row) => row.mean !== null);
  const untold = [...new Set(rows.map((row) => row.untold).filter(Boolean))].join(', or ');
  const reason = untold ? ` -: the exponent is too uncertain to print: ${untold}.` : '';
  if (rows.length === 0) return nothing(figure, `No point has ${sliceText(at)}: choose another value above.`);
  if (known.length === 0) return nothing(figure, `No point has a value of this quantity.${reason}${doubtSentence([[store(), rows]], state.quantity, true)}`);
  const spec = !state.x ? {layer: []} : state.y ? planeSpec(rows, title) : lineSpec(known, title), texts = spec.layer.some(({encoding}) => encoding.text?.field === 'cell');
  const caption = `${title}: ${state.quantity === 'beta' ? 'fit to all' : 'mean over the'} runs of each point${state.stores.length > 1 ? ` of ${store().name} (the choice Store shows the others)` : ''}${Object.keys(at).length ? ` with ${sliceText(at)}` : ''}. ${resolutionSentence(rows, texts)}${behind(at)}${!state.y && known.some((row) => row.high > row.low) ? ' Bars: 95 % intervals.' : ''} Click a ${state.y ? 'cell' : 'mark'}, or drag over several, to choose points. With the keyboard: in the table of points below.${rows.some((row) => row.twoModes) ? ' ◆: the runs have two modes, so that a mean tells little.' : ''}${reason}${state.x ? doubtSentence([[store(), rows]], state.quantity, true) : ''}`;
  if (!state.x) {
    nothing(figure, `No input was varied. ${title}: ${known.map((row) => `${row.shown} (${plural(row.n, 'run')})`).join('; ')}. ${resolutionSentence(rows, false)}${doubtSentence([[store(), rows]], state.quantity, true)}`);
    return;
  }
  const inputs = [state.x, state.y].filter(Boolean);
  const view = await draw(figure, spec, {
    name: 'plane', description: `${title} over ${inputs.map((input) => label(state.stores, input)).join(' and ')}; the table of points below has the numbers`,
    caption, command: commandOf(at), columns: ['point_id', ...inputs, 'n', 'mean', 'hw95', 'low95', 'high95', 'weak', 'untold', 'resolution', 'doubtful', 'doubts'],
    rows: rows.map((row) => [row.point_id, ...inputs.map((input) => row[input]), row.n, row.mean, row.hw95, row.low95, row.high95, row.weak, row.untold, row.resolution, row.doubt?.doubtful ?? 0, wordsOf(row.doubt).join(', ')]),
  });
  plane.view = view;
  listen(view);
  showChosen();
}

// "point 1, point 2 (16 runs) of a.db"
function list(ones) {
  const of = [...new Set(ones.map(({from}) => from))].map((one) => {
    const points = ones.filter(({from}) => from === one).map(({point}) => point), named = points.slice(0, 3).map((point) => `point ${point.point_id}`).join(', ');
    return `${named}${points.length > 3 ? ` and ${points.length - 3} more` : ''} (${plural(points.reduce((sum, point) => sum + (point.n ?? 0), 0), 'run')})${state.stores.length > 1 ? ` of ${one.name}` : ''}`;
  });
  return of.join('; ');
}

// Points of the other stores below.
function besideSentence() {
  const {drawn, left, alone} = drawnPoints(), added = drawn.filter(({from}) => from !== store());
  return `${added.length ? ` Spectrum, scatter and runs below also have ${list(added)}.` : ''}${left.length ? ` There is no room there for ${list(left)}: choose it under Store.` : ''}${
    alone ? ' Points of the other stores are drawn beside one or two chosen points only.' : ''}`;
}

export function showChosen() {
  const points = chosenPoints();
  plane.view?.signal('chosen', points.map((point) => point.point_id)).run();
  document.getElementById('chosen').textContent = points.length ? `Chosen: ${list(points.map((point) => ({from: store(), point})))}.${besideSentence()}` : 'No point is chosen.';
  for (const box of body('points').querySelectorAll('input')) box.checked = state.chosen.has(Number(box.value));
}

export function showPoints() {
  const axes = store().inputs.map((axis) => axis.column_name);
  const rows = plane.rows.slice(0, 1000);
  const boxes = (row) => element('input', {type: 'checkbox', value: row.point_id, checked: state.chosen.has(row.point_id), 'aria-label': `point ${row.point_id}`,
    change: () => choose([...body('points').querySelectorAll('input:checked')].map((box) => Number(box.value)))});
  fill(body('points'), table(`Points of ${store().name}${plane.rows.length > rows.length ? `: the first ${rows.length}` : ''}`,
    ['chosen', 'point', ...axes.map((axis) => label(state.stores, axis)), 'runs', 'failed', label(state.stores, state.quantity), 'resolution', 'modes', 'in doubt'],
    rows.map((row) => [boxes(row), row.point_id, ...axes.map((axis) => (axis === state.x || axis === state.y ? number(row[axis]) : number(inUnit(state.stores, axis, row[axis])))), row.n ?? 0, row.failed ?? 0, row.shown, row.resolutionText, row.modesText, row.doubtText])));
}

export function showChoices() {
  const {varied, quantities} = store();
  const options = (columns) => columns.map((column) => [column, label(state.stores, column)]);
  const columns = varied.map((axis) => axis.column_name);
  const set = (key) => (value) => {
    state[key] = value;
    if (key === 'x' && state.y === value) state.y = columns.find((column) => column !== value) ?? null;
    changed('plane');
  };
  const parts = [];
  if (state.stores.length > 1)
    parts.push(select('store', 'Store', state.stores.map((one, i) => [String(i), one.name]), String(state.active), (value) => {
      state.active = Number(value);
      state.chosen = new Set();
      state.at = {};
      changed('store');
    }));
  parts.push(select('quantity', 'Quantity', options([...quantities.main, 'beta', ...quantities.others]), state.quantity, set('quantity')));
  if (columns.length > 0) parts.push(select('x', 'x axis', options(columns), state.x, set('x')));
  if (columns.length > 1) parts.push(select('y', 'y axis', [['', '(nothing: a line)'], ...options(columns.filter((column) => column !== state.x))], state.y ?? '', set('y')));
  for (const [column, value] of Object.entries(slice())) { // the other inputs of a map
    const values = [...new Set(store().points.map((point) => point[column] ?? null))].sort((a, b) => (a < b ? -1 : 1));
    parts.push(select(`at-${column}`, label(state.stores, column), values.map((one) => [JSON.stringify(one), valueText(column, one)]), JSON.stringify(value), (text) => {
      state.at = {...state.at, [column]: JSON.parse(text)};
      changed('plane');
    }));
  }
  fill(document.getElementById('choices'), ...parts);
}
