// The stores of the page: those within it, and whole ones that are dropped on it.
import initSqlJs from 'sql.js';
import * as questions from './questions.js';

let SQL; // sql.js, when it has started

async function unpack(text) {
  const packed = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// All rows of a question as objects.
export function ask(store, sql, parameters = {}) {
  const {columns, rows} = answer(store, sql, parameters, Infinity);
  return rows.map((row) => Object.fromEntries(columns.map((column, i) => [column, toDouble(row[i])])));
}

// An integer that a double cannot hold, such as a seed, is a BigInt in an answer; charts take doubles.
export const toDouble = (value) => (typeof value === 'bigint' ? Number(value) : value);
const isSafe = (value) => !Number.isInteger(value) || Number.isSafeInteger(value);
const exact = (value) => (typeof value === 'bigint' && isSafe(Number(value)) ? Number(value) : value);

// Column names and at most `most` rows.
export function answer(store, sql, parameters, most) {
  const statement = store.db.prepare(sql);
  try {
    statement.bind(Object.fromEntries(Object.entries(parameters).map(([key, value]) => [`:${key}`, value])));
    const columns = statement.getColumnNames();
    const rows = [];
    let more = false;
    while (statement.step()) {
      more = rows.length === most;
      if (more) break;
      const row = statement.get();
      rows.push(row.every(isSafe) ? row : statement.get(null, {useBigInt: true}).map(exact));
    }
    return {columns, rows, more};
  } finally {
    statement.free();
  }
}

export const has = (store, table) => store.tables.has(table);

// The exponent of each point; where tables and pictures leave it out, no value but the reason, `untold`.
export const exponents = (store) => newest(ask(store, questions.exponents(store.viewed))).map((row) => (row.untold === null ? row : {...row, mean: null, hw95: null}));

// The newest version of results of each point; rows come in the order of versions.
export function newest(rows) {
  return [...new Map(rows.map((row) => [row.point_id, row])).values()];
}

// Results that differ between runs, by name: the main ones first.
function quantitiesOf(store) {
  const main = store.pointColumns.filter((column) => column.endsWith('_mean')).map((column) => column.slice(0, -5));
  const others = has(store, 'means') ? ask(store, questions.otherQuantities).map((row) => row.quantity) : variedResults(store, main);
  return {main, others};
}

const NO_RESULTS = new Set(['run_id', 'point_id', 'session_id', 'replicate', 'seed', 'results_version', 'surplus',
  'counts', 'doubtful', 'rank', 'attempt', 'finished_at']);
function variedResults(store, main) {
  const axes = new Set(store.axes.map((axis) => axis.column_name));
  const names = [...store.runColumns].filter((name) => !NO_RESULTS.has(name) && !axes.has(name) && !main.includes(name));
  if (names.length === 0) return [];
  const [row] = ask(store, questions.ranges(names));
  return names.filter((_, i) => typeof row[`l${i}`] === 'number' && typeof row[`h${i}`] === 'number' && row[`l${i}`] < row[`h${i}`]);
}

function describe(store) {
  store.tables = new Set(ask(store, questions.tables).map((row) => row.name));
  for (const needed of ['runs', 'points', 'spectra', 'estimates', 'axis', 'campaign', 'session'])
    if (!has(store, needed)) throw new Error(`it is no store of clast (it has no ${needed})`);
  const columns = (table) => ask(store, questions.columns, {table}).map((row) => row.name);
  const read = (table, question) => (has(store, table) ? ask(store, question) : []);
  store.facts = Object.fromEntries(read('fact', questions.facts).map((row) => [row.name, row.value]));
  store.labels = new Map(read('label', questions.labels).map((row) => [row.column_name, row]));
  store.units = new Map(read('column_doc', questions.units).map((row) => [row.column_name, row.unit]));
  store.axes = ask(store, questions.axes);
  store.fixed = read('fixed_axis', questions.fixedAxes); // what other parts of its file vary
  store.pointColumns = columns('points');
  store.runColumns = new Set(columns('runs'));
  store.viewed = columns('estimates').includes('untold'); // not in an older store
  store.doubtful = store.runColumns.has('doubtful') ? 'doubtful' : store.runColumns.has('warnings') ? "warnings <> ''" : '0'; // of older stores
  store.points = newest(ask(store, questions.points([...store.axes, ...store.fixed].map((axis) => axis.column_name),
    store.pointColumns.includes('excluded') ? ', excluded' : ''))); // an older store has no such column
  const values = (column) => new Set(store.points.map((point) => point[column]));
  const varied = store.axes.filter((axis) => [...values(axis.column_name)].filter((value) => value !== null).length > 1);
  store.varied = varied.length || store.points.length > 1 ? varied : store.axes; // of inputs with one value there is no picture
  store.quantities = quantitiesOf(store);
  store.canned = read('question', questions.canned);
  return store;
}

// The inputs that name a store's points: what it varies, and what differs between it and another part of a file.
export function tellInputs(stores) {
  const differs = ({column_name: column}) => {
    const values = stores.filter((store) => store.pointColumns.includes(column)).flatMap((store) => store.points.map((point) => point[column]));
    return new Set(values.filter((value) => value !== undefined)).size > 1;
  };
  for (const store of stores)
    store.inputs = [...store.axes, ...store.fixed.filter(differs)].sort((a, b) => (a.path < b.path ? -1 : 1));
}

// What common points of stores share: the point of the first store with which clast compared them, also where only one
// store varies an input; and the inputs that each varies, as stores that are dropped on the page have no more.
export const matchesOf = (from, point) => [point.place, JSON.stringify(from.axes.map(({column_name: column}) => [column, point[column]]).sort())].filter((place) => place !== undefined);

export async function openEmbedded() {
  SQL = await initSqlJs({wasmBinary: await unpack(document.getElementById('wasm').textContent), useOldExtensionFunctions: false});
  const stores = [];
  for (const element of document.querySelectorAll('script.store')) {
    const db = new SQL.Database(await unpack(element.textContent));
    element.remove();
    const store = describe({db, whole: false});
    store.name = store.facts.store;
    const first = new Map(has(store, 'difference') ? ask(store, questions.pairs).map((row) => [row.point_id, row.first_point]) : []);
    for (const point of store.points) point.place = stores.length ? first.get(point.point_id) : point.point_id;
    stores.push(store);
  }
  return stores;
}

// The header of a store in WAL mode has a 2 in byte 18. What its -wal file holds is not here then.
export async function openFile(file) {
  const bytes = new Uint8Array(await file.arrayBuffer());
  const partial = bytes[18] === 2;
  const store = {db: new SQL.Database(bytes), whole: true, partial, name: file.name};
  try {
    return describe(store);
  } catch (error) {
    store.db.close();
    throw error;
  }
}
