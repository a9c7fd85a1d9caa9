// A box for SQL over one of the page's stores, with ready questions, a chart, CSV and a link.
import {body, command, download, element, fill, select, table} from './elements.js';
import {COLOURS, draw, scale} from './chart.js';
import * as questions from './questions.js';
import {chosenPoints, state, store, writeAddress} from './state.js';
import {answer, has, toDouble} from './stores.js';
import {csv, number, plain, plural, shell, fileOf} from './words.js';

const MOST = 100000, SHOWN = 500;

const parts = {};

const isNumber = (value) => typeof toDouble(value) === 'number';

// A ready question with a parameter asks of the first chosen point and of its first run.
function withParameters(query) {
  const point = chosenPoints()[0]?.point_id ?? 1;
  let sql = query.sql.replaceAll(':point', String(point));
  if (query.parameters.split(',').includes('run'))
    sql = sql.replaceAll(':run', questions.firstRun(point));
  return sql;
}

async function showChart(figure, result, x, y) {
  const [across, up] = [x, y].map((column) => result.columns.lastIndexOf(column));
  const rows = result.rows.map((row) => [row[across], row[up]]).filter(([, value]) => isNumber(value));
  const drawn = rows.map((row) => row.map(toDouble));
  const numeric = rows.every(([value]) => isNumber(value));
  const title = (column) => plain(state.stores, column);
  await draw(figure, {data: {values: drawn.map(([a, b]) => ({x: a, y: b}))}, height: 320,
    mark: {type: 'point', filled: true, size: 45, color: COLOURS[0], tooltip: true},
    encoding: {x: numeric ? {field: 'x', type: 'quantitative', scale: scale(drawn.map(([value]) => value)), title: title(x)} : {field: 'x', type: 'nominal', title: title(x)},
      y: {field: 'y', type: 'quantitative', scale: scale(drawn.map(([, value]) => value)), title: title(y)}}},
  {name: 'question', description: `${title(y)} against ${title(x)}`, caption: `${title(y)} against ${title(x)}, ${plural(rows.length, 'row')}.`,
    columns: [x, y], rows});
}

function chartTools(result) {
  const numbers = result.columns.filter((column, i) => result.rows.some((row) => isNumber(row[i])));
  if (numbers.length === 0 || result.rows.length < 2) return null;
  const figure = element('figure', {});
  const chosen = {x: numbers[0], y: numbers.find((column) => column.endsWith('_mean')) ?? numbers[1] ?? numbers[0]};
  const again = (key) => (value) => {
    chosen[key] = value;
    showChart(figure, result, chosen.x, chosen.y);
  };
  return element('details', {toggle: (event) => event.target.open && showChart(figure, result, chosen.x, chosen.y)},
    element('summary', {}, 'As a chart'),
    element('div', {class: 'choices'}, select('across', 'x axis', result.columns.map((column) => [column, column]), chosen.x, again('x')),
      select('up', 'y axis', numbers.map((column) => [column, column]), chosen.y, again('y'))), figure);
}

export function askQuestion() {
  const sql = parts.text.value.trim();
  state.sql = sql;
  writeAddress();
  try {
    const start = performance.now();
    const result = answer(store(), sql, {}, MOST);
    const took = performance.now() - start;
    const shown = result.rows.slice(0, SHOWN);
    const told = `${plural(result.rows.length, 'row')}${result.more ? ' and more' : ''} in ${number(took / 1000, 2)} s${result.rows.length > SHOWN ? `; ${SHOWN} are listed` : ''}`;
    fill(parts.result, table(told, result.columns, shown.map((row) => row.map((value) => (value instanceof Uint8Array ? '(bytes)' : number(value, 6))))),
      element('div', {class: 'tools'}, element('button', {type: 'button', click: () => download('question.csv', 'text/csv', csv(result.columns, result.rows))}, 'CSV'),
        command(`clast query ${fileOf(store())} ${shell(sql)} --csv`)),
      element('p', {class: 'note'}, 'The address of this page now holds the question: it is a link to it.'), chartTools(result));
  } catch (error) {
    fill(parts.result, element('p', {class: 'warning', role: 'alert'}, `SQL error: ${error.message}`));
  }
}

export function showQuery() {
  const canned = state.stores.find((one) => one.canned.length)?.canned ?? [];
  parts.text = element('textarea', {id: 'sql', spellcheck: 'false', keydown: (event) => {
    if (event.key === 'Enter' && (event.ctrlKey || event.metaKey)) askQuestion();
  }});
  parts.text.value = state.sql ?? questions.start;
  parts.result = element('div', {id: 'answer', 'aria-live': 'polite'});
  const ready = canned.map((query) => element('button', {type: 'button', title: query.doc, click: () => {
    parts.text.value = withParameters(query);
    askQuestion();
  }}, query.name));
  const seen = has(store(), 'fact') ? 'the part of the store that is on this page' : 'the whole store';
  fill(body('query'), element('p', {}, `SQLite over ${seen} (${store().name}). Read runs, points, spectra, estimates; column_doc says what the columns hold. The page waits until a long question is answered.`),
    element('div', {class: 'tools', role: 'group', 'aria-label': 'Ready questions'}, ...ready),
    element('label', {for: 'sql'}, 'Question'), parts.text,
    element('div', {class: 'tools'}, element('button', {type: 'button', id: 'ask', click: askQuestion}, 'Ask (Ctrl-Enter)')), parts.result);
  if (state.sql) askQuestion();
}
