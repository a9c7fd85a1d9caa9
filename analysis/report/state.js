// What the reader has chosen. It is kept in the address, so that a link shows the same and a page that loads itself
// again stays as it was. An address is data: unknown words in it are dropped.
import {COLOURS} from './chart.js';
import {cells, effect} from './plane.js';
import {widestSpectrum} from './questions.js';
import {ask, matchesOf} from './stores.js';
import {unitOf} from './words.js';

export const state = {stores: [], active: 0, quantity: null, x: null, y: null, at: {}, chosen: new Set(), sql: null}; // at: values of other inputs by column

export const store = () => state.stores[state.active];
export const chosenPoints = () => store().points.filter((point) => state.chosen.has(point.point_id));

// A store that was named as STORE:POINT.
export const isNamed = ({facts, name, points}) => facts.file && facts.file !== name && points.length === 1;

// Points of other stores that are drawn beside this one: at the same place, or named. Masses have one unit in a chart.
function beside(point) {
  const places = matchesOf(store(), point), same = (other, candidate) => matchesOf(other, candidate).some((place) => places.includes(place));
  return state.stores.filter((other) => other !== store() && other.facts.mass_unit === store().facts.mass_unit)
    .flatMap((other) => other.points.filter((candidate) => isNamed(other) || same(other, candidate)).slice(0, 1).map((candidate) => ({from: other, point: candidate})));
}

const MOST_CHOSEN = 2; // points beside which those of other stores are drawn

// {drawn, left}: [{from, point}] of the charts and the runs, and what a chart has no colour for.
export function drawnPoints() {
  const chosen = chosenPoints().map((point) => ({from: store(), point}));
  if (chosen.length > MOST_CHOSEN) return {drawn: chosen, left: [], alone: state.stores.length > 1};
  const all = chosen.flatMap((one) => [one, ...beside(one.point)]).filter(({point}, i, list) => list.findIndex((other) => other.point === point) === i);
  let room = COLOURS.length - chosen.length;
  const fits = new Set(all.filter(({from}) => from === store() || room-- > 0));
  return {drawn: [...fits], left: all.filter((one) => !fits.has(one)), alone: false};
}

const listeners = [];
export const onChange = (listener) => listeners.push(listener);

// what: 'store', 'plane' (quantity and axes) or 'chosen'
export function changed(what) {
  writeAddress();
  for (const listener of listeners) listener(what);
}

export function writeAddress() {
  const words = new URLSearchParams();
  if (state.active) words.set('store', state.active);
  for (const key of ['quantity', 'x', 'y', 'sql']) if (state[key]) words.set(key, state[key]);
  if (Object.keys(state.at).length) words.set('at', JSON.stringify(state.at));
  if (state.chosen.size && state.chosen.size <= 200) words.set('points', [...state.chosen].join('.'));
  history.replaceState(null, '', String(words) ? `#${words}` : location.pathname); // an address that ends in # confuses Vega's links
}

export function readAddress() {
  const words = new URLSearchParams(location.hash.slice(1));
  state.active = Math.min(Math.max(0, Number(words.get('store')) || 0), state.stores.length - 1);
  for (const key of ['quantity', 'x', 'y', 'sql']) state[key] = words.get(key);
  try {
    const at = JSON.parse(words.get('at') ?? '{}');
    state.at = Object.fromEntries(store().varied.map(({column_name: column}) => [column, at[column]]).filter(([, value]) => value !== undefined));
  } catch {
    state.at = {};
  }
  const known = new Set(store().points.map((point) => point.point_id));
  state.chosen = new Set((words.get('points') ?? '').split('.').map(Number).filter((id) => known.has(id)));
}

// Fills in what is not chosen, or not known in this store.
export function complete() {
  const {varied, quantities, facts, points} = store();
  const known = [...quantities.main, ...quantities.others, 'beta'];
  if (!known.includes(state.quantity)) state.quantity = known.includes(facts.default_quantity) ? facts.default_quantity : known[0];
  const columns = varied.map((axis) => axis.column_name), ofAll = columns.filter((column) => points.every((point) => point[column] !== null));
  let first = ofAll.length ? ofAll : columns; // an input of one scene of two is no axis of both
  if (points.length > 1) { // of inputs that tell the points apart in the same way, such as the columns, rows and spacing of grains, one with a unit
    const of = new Map();
    for (const column of first) {
      const last = new Map(points.map((point, i) => [point[column], i])), groups = points.map((point) => last.get(point[column])).join();
      if (!of.has(groups) || (!unitOf([store()], of.get(groups)) && unitOf([store()], column))) of.set(groups, column);
    }
    first = [...of.values()];
  }
  if (first.length > 2 && !columns.includes(state.x)) { // the page opens on the two inputs with the largest effect
    const rows = cells(store(), state.quantity), of = new Map(first.map((column) => [column, effect(rows, column)]));
    const two = [...first].sort((a, b) => of.get(b) - of.get(a)).slice(0, 2);
    first = first.filter((column) => two.includes(column));
  }
  if (!columns.includes(state.x)) state.x = first[0] ?? null;
  if ((state.y && !columns.includes(state.y)) || state.y === state.x || state.y === null)
    state.y = state.y === '' ? '' : first.find((column) => column !== state.x) ?? (columns.length > 1 ? '' : null);
  if (state.chosen.size === 0 && points.length > 0) {
    const widest = ask(store(), widestSpectrum)[0]?.point_id; // a spectrum of dust alone shows nothing
    const first = points.find((point) => point.point_id === widest) ?? points.find((point) => point.n > 0) ?? points[0];
    state.chosen.add(first.point_id);
  }
}
