// Numbers, names and shell words for people.

// "2.5×10³³" for "2.500e+33", "10⁻⁵" for "1.000e-5".
const RAISED = '⁰¹²³⁴⁵⁶⁷⁸⁹';
const raised = (exponent) => exponent.replace('-', '⁻').replace(/\d/g, (digit) => RAISED[digit]);
const powers = (text) => text.replace(/(\.\d*?)0*e/, '$1e').replace('.e', 'e').replace(/e\+?(-?\d+)/, (_, exponent) => `×10${raised(exponent)}`).replace(/^(-?)1×/, '$1');
// The same exponent, of at most two digits, in an expression of a chart.
const digitIn = (digit) => `substring('${RAISED}', ${digit}, ${digit} + 1)`;
export const raisedIn = (exponent) => `(${exponent} < 0 ? '⁻' : '') + (abs(${exponent}) > 9 ? ${digitIn(`floor(abs(${exponent}) / 10)`)} : '') + ${digitIn(`abs(${exponent}) % 10`)}`;

export function number(value, digits = 4) {
  if (value === null || value === undefined || Number.isNaN(value)) return '-';
  if (typeof value !== 'number') return String(value);
  const size = Math.abs(value);
  if (Number.isInteger(value) && size < 1e6) return String(value);
  if (size >= 1e5 || size < 1e-3) return powers(value.toExponential(digits - 1));
  return String(Number(value.toPrecision(digits)));
}

// The digits of tables (campaign/terminal/uncertainty.c): one digit of the error, two after a leading 1.
const ONE_LEADS = 1.95;
function lastDecade(half) {
  const leading = Math.floor(Math.log10(half));
  return half < ONE_LEADS * 10 ** leading ? leading - 1 : leading;
}

const fixed = (value, places) => (places === 0 && Math.abs(value % 1) === 0.5 ? 2 * Math.round(value / 2) : value).toFixed(places); // 2.5 is 2

export function withError(mean, half) {
  if (!(half > 0) || typeof mean !== 'number') return number(mean);
  const size = Math.max(Math.abs(mean), half);
  if (size < 1e-3 || (size >= 1e6 && lastDecade(half) >= 3)) { // (3.3 ± 0.2)×10⁷
    const power = Math.floor(Math.log10(size));
    return `(${withError(mean / 10 ** power, half / 10 ** power)})×10${raised(String(power))}`;
  }
  const decade = lastDecade(half), last = mean !== 0 && Math.abs(mean) < 0.5 * 10 ** decade ? decade - 1 : decade;
  if (Math.abs(last) > 15 || Math.abs(mean) >= 1e15) return `${number(mean)} ± ${number(half, 2)}`;
  const shown = (value) => (last > 0 ? String(10 ** last * Math.round(value / 10 ** last)) : fixed(value, -last));
  return `${shown(mean)} ± ${shown(half)}`;
}

// A value with the ends of its interval, in the digits of the farther one: "0.11 (0.05 to 0.27)", "0.11 (to 0.27)", "0.11 (0.05 on)".
export function between(value, low, high) {
  const far = Math.max((high ?? value) - value, value - (low ?? value));
  if (!(far > 0)) return number(value);
  const shown = (end) => fixed(end, Math.max(0, -lastDecade(far)));
  return `${shown(value)} (${low === null ? `to ${shown(high)}` : high === null ? `${shown(low)} on` : `${shown(low)} to ${shown(high)}`})`;
}

// "0.11 (0 to 0.27)": an interval that ends with the range of its result (campaign/terminal/uncertainty.c).
function cutInterval(mean, low, high) {
  const decade = lastDecade(Math.max(high - mean, mean - low));
  const last = Math.min(high - mean, mean - low) < ONE_LEADS * 10 ** decade ? decade - 1 : decade;
  const size = Math.max(Math.abs(low), Math.abs(high)), step = 10 ** last;
  if (Math.abs(last) > 15 || size < 1e-3 || size >= 1e15) return `${number(mean, 2)} (${number(low, 2)} to ${number(high, 2)})`;
  const large = size >= 1e6 && last >= 3; // 3×10⁷ (0 to 5×10⁷)
  const shown = (value) => (large && value > 0 ? number(value, Math.max(1, Math.floor(Math.log10(value)) - last + 1))
    : last > 0 ? String(step * Math.round(value / step)) : fixed(value, -last));
  const end = (value) => (value === 0 || value === 1 ? String(value) : shown(value));
  return `${shown(mean)} (${end(low)} to ${end(high)})`;
}

// A mean with its interval; of equal shares, what they bound.
export function withInterval({mean, hw95, low95, high95, weak}) {
  if (hw95 === null && typeof low95 === 'number') return `${number(mean)} (all equal to 14 digits: ${number(low95, 3)} to ${number(high95, 3)})`;
  const cut = typeof low95 === 'number' && hw95 > 0 && Math.max(low95 - (mean - hw95), mean + hw95 - high95) > 1e-6 * hw95; // by the result's range
  return (cut ? cutInterval(mean, low95, high95) : withError(mean, hw95)) + (weak ? ' (weak)' : '');
}

// A number that rests on runs in doubt has a "!"; where the values of some are withheld, also the number of the others.
export const marked = (text, doubt, n) => (!doubt || text === '-' ? text : `${text}${doubt.withheld ? ` (${n - doubt.withheld})` : ''} !`);

export const plural = (count, word) => `${count} ${word}${count === 1 ? '' : 's'}`;

// The first store that names a column decides its name and its unit: inputs are shown in the unit that the campaign
// gives them in, and one of it is `factor` in SI.
const named = (stores, column) => stores.map((store) => store.labels.get(column)).find(Boolean);

// The values that a result can have: share, least, most.
export const rangeOf = (stores, column) => named(stores, column) ?? {};

// The column in SI by its own words.
export function plain(stores, column) {
  const unit = stores.map((store) => store.units.get(column)).find(Boolean);
  return column.replaceAll('_', ' ') + (unit ? ` (${unit})` : '');
}

export function label(stores, column) {
  if (column === 'beta') return 'exponent β of F(m) ~ m^-β';
  const entry = named(stores, column);
  return entry ? entry.label + (entry.unit ? ` (${entry.unit})` : '') : plain(stores, column);
}

// That unit behind a number.
export function unitOf(stores, column) {
  const unit = named(stores, column)?.unit;
  return unit ? ` ${unit}` : '';
}

// A value of the store in the unit of label().
export const inUnit = (stores, column, value) => (typeof value === 'number' ? value / (named(stores, column)?.factor ?? 1) : value);

// A word of a shell's command line.
export const shell = (text) => (/^[\w./:,=+-]+$/.test(text) ? text : `'${String(text).replaceAll("'", "'\\''")}'`);
// The name of a store on a command line; a dash in front would be an option.
const shellFile = (text) => shell(text.startsWith('-') ? `./${text}` : text);
// The file of a store for other commands than `clast report` and `clast compare`, which also take STORE:POINT.
export const fileOf = (store) => shellFile(store.facts.file ?? store.name);
export const operandOf = (store) => shellFile(store.name);
// Options of other commands that choose the runs of the page and, of these, those that meet a condition.
export function onlyOf({facts}, condition) {
  const where = [facts.where, condition].filter(Boolean), all = where.length > 1 ? where.map((one) => `(${one})`).join(' AND ') : where[0];
  return `${facts.campaign ? ` --campaign ${shell(facts.campaign)}` : ''}${facts.studies ? ' --studies' : ''}${all ? ` --where ${shell(all)}` : ''}`;
}

// A text that a spreadsheet would run as a formula gets an apostrophe, as in the tables of clast.
export function csv(columns, rows) {
  const cell = (value) => {
    const bare = value === null || value === undefined ? '' : value instanceof Uint8Array ? '(bytes)' : String(value);
    const text = typeof value === 'string' && /^\s*[=+\-@]/.test(value) && Number.isNaN(Number(value)) ? `'${bare}` : bare;
    return /[",\n\r]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  };
  return [columns, ...rows].map((row) => row.map(cell).join(',')).join('\n') + '\n';
}
