// What was asked, what was computed and by which program, what failed, and what this page leaves out.
import {body, element, fill, list, table} from './elements.js';
import * as questions from './questions.js';
import {ask} from './stores.js';
import {inUnit, number, plural, unitOf} from './words.js';

const sum = (points, key) => points.reduce((total, point) => total + (point[key] ?? 0), 0);

const when = (time) => (time ? `${time.slice(0, 16).replace('T', ' ')} UTC` : '(running or killed)'); // as people write it

// "disc-explosion, 1093 grains, 20 seeds a point"
function scene(stores) {
  const points = stores.flatMap((store) => store.points), runs = points.map((point) => point.n);
  const names = [...new Set(points.map((point) => point.scene))].join(', '), least = Math.min(...runs), most = Math.max(...runs);
  const told = stores.filter((store) => store.facts.elements), equal = new Set(told.map((store) => store.facts.elements)).size === 1;
  const elements = told.slice(0, equal ? 1 : told.length).map((store) => `${store.facts.elements}${equal ? '' : ` (${store.name})`}, `).join('');
  return points.length ? `Scene ${names}, ${elements}${least < most ? `${least} to ` : ''}${plural(most, 'seed')} a point. ` : '';
}

function varied(store) {
  return store.inputs.map((axis) => {
    const given = store.points.map((point) => point[axis.column_name]).filter((value) => value !== null), without = store.points.length - given.length;
    const values = [...new Set(given.map((value) => inUnit([store], axis.column_name, value)))];
    const numbers = values.filter((value) => typeof value === 'number').sort((a, b) => a - b);
    const listed = [...numbers, ...values.filter((value) => typeof value !== 'number')];
    const shown = (listed.length <= 8 || numbers.length === 0 ? listed.map((value) => number(value)).join(', ')
      : `${listed.length} values from ${number(numbers[0])} to ${number(numbers[numbers.length - 1])}`) + (without ? `; none in ${plural(without, 'point')}` : '');
    const path = element('span', {}, ...axis.path.split(/(?<=\.)/).flatMap((part) => [element('wbr'), part])); // lines end between its words
    return [path, shown, unitOf([store], axis.column_name), axis.meaning];
  });
}

function computed(store) {
  const {points} = store;
  const counted = sum(points, 'n'), failed = sum(points, 'failed'), censored = sum(points, 'censored'), surplus = sum(points, 'surplus');
  const parts = [`${plural(counted, 'run')} in statistics`];
  if (censored) parts.push(`${censored} of them met their end time while fragments may still have been breaking`);
  if (failed) parts.push(`${plural(failed, 'run')} without a usable result: if they fail for a reason that depends on the result, means are biased`);
  const excluded = sum(points, 'excluded');
  if (excluded) parts.push(`${plural(excluded, 'run')} excluded (clast exclude lists them)`);
  if (store.facts.chosen) parts.push(`only ${store.facts.chosen}`);
  if (surplus) parts.push(`${surplus} after the stop of a stopping rule`);
  const without = points.filter((point) => !point.n).length;
  if (without) parts.push(`${plural(without, 'point')} without a counted run`);
  return parts.join('; ');
}

function programs(store) {
  const sessions = ask(store, questions.sessions);
  const names = new Set(sessions.map((s) => `clast ${s.version ?? '?'}, commit ${(s.commit_id ?? '?').slice(0, 10)}, ${s.compiler ?? ''} on ${s.host}`));
  const last = sessions[sessions.length - 1];
  return [...names].join('; ') + (last ? `. Last session: ${when(last.started_at)} to ${when(last.ended_at)}` : '');
}

function thinned(store) {
  if (store.whole) return store.partial ? 'nothing; but the file was being written when it was copied: without its -wal file the last runs may be missing' : 'nothing';
  const {facts} = store, parts = ['fragment masses of single runs'];
  const kept = ask(store, questions.keptRuns)[0].n, all = Number(facts.runs);
  if (kept < all) parts.push(`single runs: of ${all}, ${kept} are here, the first ${plural(Number(facts.replicates_kept), 'seed')} of ${Number(facts.runs_of_every_nth_point) > 1 ? `every ${facts.runs_of_every_nth_point}th` : 'each'} point`);
  if (Number(facts.results_left_out)) parts.push(`${plural(Number(facts.results_left_out), 'result')} of single runs (their means are here)`);
  if (Number(facts.spectra_of_every_nth_point) > 1) parts.push(`spectra, but of every ${facts.spectra_of_every_nth_point}th point`);
  if (Number(facts.points_of_studies)) parts.push(`${plural(Number(facts.points_of_studies), 'point')} (${plural(Number(facts.runs_of_studies), 'run')}) of studies and searches (--studies)`);
  if (Number(facts.pictures_left_out)) parts.push(`${plural(Number(facts.pictures_left_out), 'picture')} of kept fields (of run ${facts.pictures_left_out_of}: no room, ${facts.pictures_room})`);
  if (Number(facts.pictures_not_drawn)) parts.push(`${plural(Number(facts.pictures_not_drawn), 'picture')}: the fields files cannot be read`);
  return `${parts.join('; ')}. Results of single runs have 7 digits. Statistics are of all runs of the points here. Drop the whole store below to see all of it.`;
}

function failures(store) {
  const rows = [...ask(store, questions.failedRuns), ...ask(store, questions.failedAttempts)];
  if (rows.length === 0) return element('p', {}, 'Nothing failed.');
  return table('What failed: runs without a usable result, and attempts that ended by a limit or a crash',
    ['reason', 'number', 'one message'], rows.map((row) => [row.reason, row.n, row.example || '']));
}

function one(store) {
  const campaigns = ask(store, questions.campaigns);
  const number = (c) => (campaigns.filter(({name}) => name === c.name).length > 1 ? `, number ${c.campaign_id}` : ''); // what --campaign takes
  return element('div', {},
    element('h3', {}, store.name),
    list([
      ['campaigns', [...new Set(campaigns.map((c) => `${c.name} (${when(c.added_at)})`))].join(', ') || 'none'],
      ['computed', `${plural(store.points.length, 'point')}; ${computed(store)}`],
      ['by', programs(store)],
      ['left out here', thinned(store)],
    ]),
    store.inputs.length ? table('Inputs that were varied', ['input', 'values', 'unit', 'meaning'], varied(store)) : element('p', {}, 'No input was varied.'),
    failures(store),
    ...campaigns.map((c) => element('details', {}, element('summary', {}, `The campaign file of ${c.name}${number(c)}`), element('pre', {}, c.document))));
}

export function showAsked(stores) {
  fill(body('asked'), ...stores.map(one));
}

const NAMED = 3; // campaigns in the title

// Names of the campaigns whose points are on the page: without studies and searches, where their points are left out.
function named(store) {
  const all = ask(store, questions.campaigns), own = all.filter((c) => !c.document?.startsWith('# Written by clast '));
  return (own.length && !store.facts.studies ? own : all).map((c) => c.name);
}

export function showTitle(stores) {
  const names = [...new Set(stores.flatMap(named))];
  const title = names.length ? names.slice(0, NAMED).join(', ') + (names.length > NAMED ? ` and ${names.length - NAMED} more` : '') : stores.map((store) => store.name).join(', ');
  document.title = `${title} - clast`;
  document.getElementById('title').textContent = title;
  const {facts} = stores[0];
  document.getElementById('made').textContent = `${scene(stores)}Made ${facts.made_at} by ${facts.program.replace(/(commit .{10})\w*/, '$1')}.`;
}
