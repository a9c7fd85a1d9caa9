// The plane without a mouse: arrow keys move a frame from cell to cell, the space bar takes the cell into the choice or
// out of it, and with Shift the arrows choose all cells between where they began and the frame, as a brush does.

const STEPS = {ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]};

// places: [{x, y, ids}], a place for all points that are drawn in one cell; x grows to the right and y upwards.
export function placesOf(rows, xOf, yOf) {
  const places = new Map();
  for (const row of rows) {
    const x = xOf(row), y = yOf(row), key = `${x} ${y}`;
    if (!places.has(key)) places.set(key, {x, y, ids: []});
    places.get(key).ids.push(row.point_id);
  }
  return [...places.values()];
}

// The nearest place on that side. What lies aside counts three times, so that a row or column is followed to its end.
function next(places, from, [right, up]) {
  let best = null, least = Infinity;
  for (const place of places) {
    const dx = place.x - from.x, dy = place.y - from.y, along = dx * right + dy * up;
    const far = along + 3 * Math.abs(right ? dy : dx);
    if (along > 1e-9 && far < least) [best, least] = [place, far];
  }
  return best;
}

const between = (value, a, b) => value >= Math.min(a, b) - 1e-9 && value <= Math.max(a, b) + 1e-9;

// Listens to the keys of a chart. does: {chosen(): ids, choose(ids), show(place or null)}
export function listenToKeys(chart, places, does) {
  let at = null, anchor = null;
  const start = () => places.find((place) => place.ids.some((id) => does.chosen().has(id))) ?? places[0];
  const toggle = () => {
    const ids = new Set(does.chosen()), all = at.ids.every((id) => ids.has(id));
    for (const id of at.ids) all ? ids.delete(id) : ids.add(id);
    does.choose([...ids]);
  };
  const move = (step, block) => {
    const from = at;
    at = next(places, from, step) ?? from;
    anchor = block ? anchor ?? from : null;
    does.show(at);
    if (block) does.choose(places.filter((place) => between(place.x, anchor.x, at.x) && between(place.y, anchor.y, at.y)).flatMap((place) => place.ids));
  };
  chart.addEventListener('focus', () => does.show((at ??= start())));
  chart.addEventListener('blur', () => does.show(null));
  chart.addEventListener('keydown', (event) => {
    const step = STEPS[event.key];
    if (!at || event.ctrlKey || event.altKey || event.metaKey || (!step && event.key !== ' ' && event.key !== 'Enter')) return;
    event.preventDefault(); // the page does not scroll
    step ? move(step, event.shiftKey) : toggle();
  });
}
