// The fragment mass spectrum of the chosen points with its intervals and the fitted power law: each point for itself, or all
// of them together when they are too many to be told apart.
import {COLOURS, DASHES, ROOM, SHAPES, draw, heightWith, logAxis, nothing} from './chart.js';
import * as questions from './questions.js';
import {chosenPoints, drawnPoints, state, store} from './state.js';
import {cells, doubtSentence} from './plane.js';
import {pool} from './statistics.js';
import {ask, exponents, has} from './stores.js';
import {inUnit, marked, number, onlyOf, plural, fileOf, unitOf, withError} from './words.js';

export const inputsOf = (from, point, axes = from.inputs) => axes.filter((axis) => point[axis.column_name] !== null).map((axis) => `${axis.path.split('.').pop()} ${number(inUnit(state.stores, axis.column_name, point[axis.column_name]))}${unitOf(state.stores, axis.column_name)}`).join(', ');

export const nameOf = (from, point) =>
  `${state.stores.length > 1 ? `${from.name}: ` : ''}${inputsOf(from, point) || `point ${point.point_id}`}, ${plural(point.n ?? 0, 'run')}`;

function binsOf(from, point) {
  const rows = ask(from, questions.spectrum, {point: point.point_id});
  const version = rows[rows.length - 1]?.results_version;
  return rows.filter((row) => row.results_version === version && row.count > 0);
}

function completeMass(from, points) {
  const question = has(from, 'means') ? questions.completeMass : from.runColumns.has('complete_mass') ? questions.completeMassOfRuns : null;
  const values = question ? points.map((point) => ask(from, question, {point: point.point_id})[0]?.mean).filter((mean) => mean > 0) : [];
  return values.length ? Math.max(...values) : 0;
}

// [{name, bins, points, from, complete}] of what is drawn.
function curves() {
  const each = drawnPoints().drawn.filter(({point}) => point.n > 0), points = each.map(({point}) => point);
  if (each.length <= COLOURS.length)
    return each.map(({from, point}) => ({name: nameOf(from, point), from, points: [point], complete: completeMass(from, [point]), bins: binsOf(from, point)})).filter((curve) => curve.bins.length);
  const spectra = points.map((point) => binsOf(store(), point)).filter((bins) => bins.length);
  return spectra.length ? [{name: `${plural(spectra.length, 'point')} together`, from: store(), points, complete: completeMass(store(), points), bins: pool(spectra)}] : [];
}

// The line of m^-beta that holds as many fragments per run in its window as the fit was made from.
function fitOf(curve) {
  if (curve.points.length !== 1) return null;
  const fit = exponents(curve.from).find((row) => row.point_id === curve.points[0].point_id);
  if (!fit || !(fit.lower > 0)) return null;
  if (fit.mean === null) return {text: `no β: ${fit.untold}`, ends: []};
  const upper = Math.min(fit.upper ?? Infinity, Math.max(...curve.bins.map((bin) => bin.upper)));
  const power = 1 - fit.mean;
  const integral = Math.abs(power) < 1e-9 ? Math.log(upper / fit.lower) : (upper ** power - fit.lower ** power) / power;
  const factor = fit.n / curve.points[0].n / integral;
  return {text: `β = ${withError(fit.mean, fit.hw95)} from ${number(fit.lower, 2)} ${curve.from.facts.mass_unit ?? 'kg'} on`, ends: [fit.lower, upper].map((mass) => ({mass, density: factor * mass ** -fit.mean, name: curve.name}))};
}

function marksOf(curve) {
  return curve.bins.map((bin) => {
    const width = bin.upper - bin.lower, density = bin.count_mean / width, half = (bin.count_hw95 ?? 0) / width;
    return {name: curve.name, mass: Math.sqrt(bin.lower * bin.upper), lower: bin.lower, upper: bin.upper, pale: bin.lower < curve.complete, density, low: density - half,
      high: density + half, hw95: bin.count_hw95 === null ? null : half, count: bin.count, shown: `${number(density, 3)}${bin.count_hw95 === null ? '' : ` ± ${number(half, 2)}`}`};
  });
}

// Options that choose these points on a command line.
function whereOf(from, points) {
  if (points.length === 1) return ` --point ${points[0]}${onlyOf(from)}`;
  return onlyOf(from, points.length === from.points.length ? '' : `point_id in (${points.join(', ')})`);
}

// One command for the drawn points of each file and campaign. make: the command's words in front of and behind the file's
// name, and the name of its picture.
export function commandsOf(points, [front, behind, picture]) {
  const of = new Map(); // in the order of the chart
  for (const {from, point} of points) {
    const key = JSON.stringify([fileOf(from), from.facts.campaign]);
    of.set(key, [...(of.get(key) ?? []), {from, point}]);
  }
  return [...of.values()].map((own, i) =>
    `${front} ${fileOf(own[0].from)}${whereOf(own[0].from, own.map(({point}) => point.point_id))}${behind} --picture ${picture}${of.size > 1 ? `-${i + 1}` : ''}.png`);
}

export async function showSpectrum() {
  const figure = document.querySelector('#spectrum figure');
  const drawn = curves();
  if (drawn.length === 0)
    return nothing(figure, chosenPoints().length ? 'No spectrum of the chosen points is on this page (see "left out here").' : 'Choose a point.');
  const rows = drawn.flatMap(marksOf), fits = drawn.map(fitOf);
  const complete = [...new Set(drawn.map(({complete}) => complete).filter(Boolean).sort((a, b) => a - b).map((mass) => number(mass, 2)))];
  const names = drawn.map((curve) => curve.name), kg = drawn[0].from.facts.mass_unit ?? 'kg';
  const x = {field: 'mass', type: 'quantitative', scale: {type: 'log', ...ROOM}, title: `fragment mass m (${kg})`, axis: logAxis(rows.map((row) => row.mass))};
  const low = Math.min(...rows.map((row) => (row.low > 0 ? row.low : row.density / 3))), high = Math.max(...rows.map((row) => row.high));
  const room = Math.max(1.1, (high / low) ** 0.05), foot = low / room; // of the axis; only an interval that reaches 0 ends there
  for (const row of rows) row.low = row.low > 0 ? row.low : foot / 10;
  const y = (field) => ({field, type: 'quantitative', scale: {type: 'log', domainMin: foot, domainMax: high * room, nice: false}, title: `F(m), fragments per run and ${kg}`, axis: logAxis([foot, high * room])});
  const legend = drawn.length > 1 ? {orient: 'bottom', direction: 'vertical', title: null, symbolOpacity: 1} : null;
  const colour = {field: 'name', type: 'nominal', scale: {domain: names, range: COLOURS}, legend};
  const layer = [
    {transform: [{filter: 'datum.hw95 !== null'}], mark: {type: 'rule', strokeWidth: 3, opacity: 0.4, clip: true, tooltip: null}, encoding: {x, y: y('low'), y2: {field: 'high'}, color: colour}},
    {mark: {type: 'point', filled: true, size: 50}, encoding: {x, y: y('density'), color: colour,
      shape: {field: 'name', type: 'nominal', scale: {domain: names, range: SHAPES}, legend},
      opacity: {condition: {test: 'datum.pale', value: 0.3}, value: 1},
      tooltip: [{field: 'name', title: 'point'}, {field: 'mass', format: '.3~e', title: `m (${kg})`}, {field: 'shown', title: 'F(m)'}, {field: 'count', title: 'fragments'}]}},
    {data: {values: fits.flatMap((fit) => fit?.ends ?? [])}, mark: {type: 'line', strokeWidth: 2, clip: true}, encoding: {x, y: y('density'),
      color: colour, strokeDash: {field: 'name', type: 'nominal', scale: {domain: names, range: DASHES}, legend}}},
  ];
  const doubted = new Map(drawn.map((curve) => [curve.from, cells(curve.from, 'beta')]));
  const of = (curve) => doubted.get(curve.from).filter((cell) => curve.points.some((point) => point.point_id === cell.point_id));
  const told = drawn.map((curve, i) => marked(`${curve.name}${fits[i] ? `: ${fits[i].text}` : ''}`, of(curve).some((cell) => cell.doubt) && {withheld: 0})).join('; ');
  await draw(figure, {data: {values: rows}, height: heightWith(names), layer}, {
    name: 'spectrum', description: `Fragment mass spectrum of ${told}`,
    caption: `${told}. ${drawn[0].points.length > 1 ? 'Points together have no bars here: the clast command below has their intervals.' : 'Bars: 95 % intervals over seeds, down to the axis where one reaches 0.'}${fits.some((fit) => fit?.ends.length) ? ' Lines: F(m) ~ m^-β by maximum likelihood without the largest fragment of each run, which the marks have.' : ''}${complete.length ? ` Pale marks: below ${complete.join(', ')} ${kg} fragments are missing (too few particles or grains).` : ''}${doubtSentence(drawn.map((curve) => [curve.from, of(curve)]), 'beta')}`,
    command: commandsOf(drawn.flatMap(({from, points}) => points.map((point) => ({from, point}))), ['clast spectrum', drawn[0].points.length > 1 ? ' --by ""' : '', 'spectrum']),
    columns: ['point', 'lower_kg', 'upper_kg', 'fragments', 'number_density', 'number_density_hw95'],
    rows: rows.map((row) => [row.name, row.lower, row.upper, row.count, row.density, row.hw95]),
  });
}
