// The runs of the chosen points, and one run: its picture, or the command that computes it again.
import {body, command, element, fill, list, table} from './elements.js';
import * as questions from './questions.js';
import {drawnPoints, state, store} from './state.js';
import {answer, ask, has} from './stores.js';
import {inUnit, label, marked, number, plural, fileOf} from './words.js';

const SHOWN = 200;
let order = {column: null, down: false};

function columnsOf(from) {
  const wanted = [...new Set([state.quantity, ...from.quantities.main, 'wall_time'])];
  return wanted.filter((column) => from.runColumns.has(column));
}

const ofStore = (from) => (state.stores.length > 1 ? ` of ${from.name}` : '');

function pictureOf(from, row) {
  const place = row.quantile === 0 ? 'least' : row.quantile === 1 ? 'largest' : 'median';
  const of = row.quantile === null ? '' : `: ${place} ${label(state.stores, from.facts.pictures_by ?? '')} of its point`;
  return element('figure', {}, element('img', {src: URL.createObjectURL(new Blob([row.png], {type: 'image/png'})), alt: `The broken body of run ${row.run_id}`}),
    element('figcaption', {}, `Run ${row.run_id}${ofStore(from)}${of}`));
}

function showRun(from, id) {
  const {columns, rows: [row]} = answer(from, questions.run, {run: id}, 1);
  const [picture] = has(from, 'picture') ? ask(from, questions.pictureOfRun, {run: id}) : [];
  const file = fileOf(from);
  const pairs = columns.map((column, i) => [column, row[i]]).filter(([, value]) => value !== null && value !== '' && !(value instanceof Uint8Array))
    .map(([column, value]) => [label(state.stores, column), number(inUnit(state.stores, column, value), 7)]);
  fill(document.getElementById('run'), element('h3', {tabindex: -1, id: 'run-title'}, `Run ${id}${ofStore(from)}`),
    picture ? pictureOf(from, picture) : element('p', {}, 'Its picture is not on this page.'),
    element('p', {}, 'These commands compute the run again, bit by bit, and draw it:'),
    element('p', {}, command(`clast replay ${file} ${id} --fields run${id}.h5`)),
    element('p', {}, command(`clast picture run${id}.h5 run${id}.png`)),
    element('details', {}, element('summary', {}, 'All that this page knows of it'), list(pairs)));
  document.getElementById('run-title').focus();
}

function sorted(rows, columns) {
  if (!order.column || !columns.includes(order.column)) return rows;
  const key = order.column, sign = order.down ? -1 : 1;
  return rows.sort((a, b) => sign * (typeof a[key] === 'number' && typeof b[key] === 'number' ? a[key] - b[key] : String(a[key] ?? '').localeCompare(String(b[key] ?? ''))));
}

export function showRuns() {
  const {drawn} = drawnPoints(), stores = [...new Set([store(), ...drawn.map(({from}) => from)])], results = columnsOf(store());
  const columns = [...(state.stores.length > 1 ? ['store'] : []), 'run_id', 'point_id', 'seed', 'state', ...results];
  const runsOf = ({from, point}) => ask(from, questions.runs(results.filter((column) => from.runColumns.has(column)), from.doubtful), {point: point.point_id});
  const rows = sorted(drawn.flatMap((one) => runsOf(one).map((row) => ({...row, from: one.from, store: one.from.name}))), columns);
  const marksOf = (from, column) => new Set(has(from, 'doubt_mark') ? ask(from, questions.marks, {quantity: column}).map((row) => `${row.engine} ${row.words}`) : []);
  const marks = new Map(stores.map((from) => [from, new Map(results.map((column) => [column, marksOf(from, column)]))]));
  const isMarked = (row, column) => results.includes(column) && row.counts && (has(row.from, 'doubt_mark') ? marks.get(row.from).get(column).has(`${row.engine} ${row.warnings}`) : row.doubtful);
  const heading = (column) => ({store: 'store', run_id: 'run', point_id: 'point', seed: 'seed', state: 'state'})[column] ?? label(state.stores, column);
  const cell = (row, column) => column === 'run_id'
    ? element('button', {type: 'button', 'aria-label': `run ${row.run_id}`, click: () => showRun(row.from, row.run_id)}, String(row.run_id)) : marked(number(row[column]), isMarked(row, column) && {withheld: 0});
  const isDoubted = (row) => results.some((column) => isMarked(row, column));
  const pictures = drawn.slice(0, 4).filter(({from}) => has(from, 'picture'))
    .flatMap(({from, point}) => ask(from, questions.pictures, {point: point.point_id}).map((row) => pictureOf(from, row)));
  const which = `the chosen points${stores.length > 1 ? ' and of those drawn with them' : ''}`;
  fill(document.getElementById('run'));
  fill(body('runs'),
    rows.length ? table(`${plural(rows.length, 'run')} of ${which}${rows.length > SHOWN ? `; ${SHOWN} of them are listed` : ''}. A heading sorts; a run's number shows it.${rows.some(isDoubted) ? ' !: in doubt; the run has the words of the conditions that it breaks.' : ''}`,
      columns.map(heading), rows.slice(0, SHOWN).map((row) => columns.map((column) => cell(row, column))), (i) => {
        order = {column: columns[i], down: order.column === columns[i] && !order.down};
        showRuns();
      }) : element('p', {class: 'note'}, 'No run of the chosen points is on this page.'),
    pictures.length ? element('div', {class: 'pictures'}, ...pictures) : null);
}
