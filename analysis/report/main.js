// The page of `clast report`: opens the stores within it and keeps its parts in step with what the reader chooses.
import {showAsked, showTitle} from './asked.js';
import {showCompare} from './compare.js';
import {showChoices, showChosen, showPlane, showPoints} from './plane.js';
import {showQuery} from './query.js';
import {showRuns} from './runs.js';
import {showSeeds} from './seeds.js';
import {showSpectrum} from './spectrum.js';
import {complete, onChange, readAddress, state, writeAddress} from './state.js';
import {openEmbedded, openFile, tellInputs} from './stores.js';

const tell = (text) => (document.getElementById('status').textContent = text);

let showing = 0; // calls of show() that are not over

async function show(what) {
  document.body.ariaBusy = String(++showing > 0);
  await showParts(what).finally(() => (document.body.ariaBusy = String(--showing > 0)));
  document.body.dataset.shown = String(Number(document.body.dataset.shown ?? 0) + 1); // for tests and for those who print
}

async function showParts(what) {
  complete();
  if (what === 'store') {
    showAsked(state.stores);
    showQuery();
  }
  if (what !== 'chosen') {
    showChoices();
    await showPlane();
    showPoints();
    showCompare();
  }
  showChosen();
  showRuns();
  await Promise.all([showSpectrum(), showSeeds()]);
}

async function add(file) {
  try {
    tell(`Reading ${file.name} ...`);
    state.stores.push(await openFile(file));
    tellInputs(state.stores);
    state.active = state.stores.length - 1;
    state.chosen = new Set();
    await show('store');
    tell(`${file.name} is added.`);
  } catch (error) {
    tell(`${file.name} cannot be read: ${error.message}.`);
  }
}

function takeDrops() {
  const mark = (on) => (event) => {
    event.preventDefault();
    document.body.classList.toggle('dropping', on);
  };
  addEventListener('dragover', mark(true));
  addEventListener('dragleave', mark(false));
  addEventListener('drop', (event) => {
    mark(false)(event);
    for (const file of event.dataTransfer.files) add(file);
  });
  document.getElementById('file').addEventListener('change', (event) => {
    for (const file of event.target.files) add(file);
  });
}

// Charts have the width of their column.
function followWidth() {
  let width = innerWidth, waiting;
  addEventListener('resize', () => {
    clearTimeout(waiting);
    waiting = setTimeout(() => {
      if (innerWidth === width) return;
      width = innerWidth;
      show('plane');
    }, 200);
  });
}

// `clast report --watch` writes the page again; a reader in the middle of a question is not interrupted.
function loadAgain(seconds) {
  if (!(seconds > 0)) return;
  tell(`The campaign is running: this page loads itself again every ${seconds} s.`);
  setInterval(() => {
    if (document.activeElement?.tagName !== 'TEXTAREA' && state.stores.every((store) => !store.whole)) location.reload();
  }, 1000 * seconds);
}

async function start() {
  try {
    state.stores = await openEmbedded();
    tellInputs(state.stores);
    readAddress();
    complete();
    writeAddress();
    showTitle(state.stores);
    onChange(show);
    takeDrops();
    followWidth();
    tell('');
    await show('store');
    loadAgain(Number(state.stores[0].facts.refresh));
  } catch (error) {
    tell(`This page cannot show its data: ${error.message}. It needs a browser of 2023 or later.`);
    throw error;
  }
}

start();
