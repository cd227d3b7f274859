// The laboratory in a browser, from disk: it checks, runs, compares, shows and saves, and asks for nothing outside.
// PAGE is the page, USAR the program, CHROMIUM the browser, SHOTS a folder for screenshots.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { createServer } from 'node:http';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { chromium } from 'playwright-core';

const pathOf = (path) => new URL(path, import.meta.url).pathname;
const lab = process.env.PAGE ?? pathOf('../../target/lab/usar-lab.html');
const usar = process.env.USAR ?? pathOf('../../target/release/usar');
const executablePath = process.env.CHROMIUM ?? '/usr/bin/chromium';
const folder = mkdtempSync(join(tmpdir(), 'usar-lab-'));

let browser;

before(async () => {
  browser = await chromium.launch({ executablePath, args: ['--no-sandbox', '--disable-gpu'] });
});

after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true });
});

/** Opens the laboratory from disk; every message, error and request to elsewhere is noted. */
async function open({ file = lab, hash = '', cores = 4, ...options } = {}) {
  const context = await browser.newContext({ viewport: { width: 1400, height: 900 }, ...options });
  const page = await context.newPage();
  const complaints = [];
  page.on('console', (message) => complaints.push(`console: ${message.text()}`));
  page.on('pageerror', (error) => complaints.push(`error: ${error.message}`));
  page.on('dialog', (dialog) => complaints.push(`dialog: ${dialog.message()}`));
  page.on('request', (request) => {
    const url = request.url().split('#')[0];
    if (url !== `file://${file}` && !url.startsWith('blob:')) complaints.push(`request: ${url}`);
  });
  await page.addInitScript((count) => {
    Object.defineProperty(navigator, 'hardwareConcurrency', { get: () => count });
    // Every picture that is asked for is counted: each viewer that is not gone asks once a frame.
    const ask = window.requestAnimationFrame.bind(window);
    window.asked = 0;
    window.requestAnimationFrame = (act) => {
      window.asked += 1;
      return ask(act);
    };
  }, cores);
  const begin = performance.now();
  await page.goto(`file://${file}${hash}`);
  await page.waitForSelector('html[data-ready="yes"]', { timeout: 20_000 });
  const ready = performance.now() - begin;
  const done = async () => {
    assert.deepEqual(complaints, []);
    await context.close();
  };
  return { page, ready, done };
}

const editor = '.cm-content';
const status = (page) => page.textContent('.choices .status');

/** The text that the editor shows. CodeMirror draws what can be seen; its view knows all. */
const text = (page) =>
  page.evaluate(() => document.querySelector('.cm-content').cmTile.view.state.doc.toString());

/** Puts the cursor behind a text in the editor. */
const cursorBehind = (page, part) =>
  page.evaluate((wanted) => {
    const { view } = document.querySelector('.cm-content').cmTile;
    const anchor = view.state.doc.toString().indexOf(wanted) + wanted.length;
    view.dispatch({ selection: { anchor }, scrollIntoView: true });
    view.focus();
  }, part);

/** Replaces the text that the editor shows, as the reader would. */
async function write(page, content) {
  await page.click(editor);
  await page.keyboard.press('Control+a');
  await page.keyboard.insertText(content);
}

async function choose(page, { a, b, seeds }) {
  if (a) await page.fill('[aria-label="Policy A"]', a);
  if (b) await page.fill('[aria-label="Policy B"]', b);
  if (seeds) await page.fill('[aria-label="Seeds"]', seeds);
}

/** Runs what the fields say to its end. */
async function run(page, choice = {}) {
  await choose(page, choice);
  await page.click('[aria-label^="Run all"]');
  await page.waitForFunction(
    () => /^Done|^Cancelled/.test(document.querySelector('.choices .status').textContent),
    undefined,
    { timeout: 120_000 },
  );
}

/** Gives the first number of the text another value, so that trials are short. */
const shorten = (page, seconds) =>
  page.evaluate((value) => {
    const { view } = document.querySelector('.cm-content').cmTile;
    const found = /duration_s: ([\d.]+)/.exec(view.state.doc.toString());
    const from = found.index + found[0].length - found[1].length;
    view.dispatch({ changes: { from, to: from + found[1].length, insert: value } });
  }, seconds.toFixed(1));

const cells = (page, row, kind) =>
  page.$$eval(`.pairs tbody tr:nth-child(${row}) ${kind}`, (all) => all.map((cell) => cell.textContent));

/** How many pictures are asked for in a second. */
async function picturesASecond(page) {
  await page.waitForTimeout(200);
  return page.evaluate(async () => {
    const before = window.asked;
    await new Promise((resolve) => setTimeout(resolve, 1000));
    return window.asked - before;
  });
}

test('it is ready within three seconds, from disk, and small', async () => {
  const { page, ready, done } = await open();
  assert.ok(ready < 3000, `${ready} ms`);
  assert.ok(readFileSync(lab).length <= 2.5e6, `${readFileSync(lab).length} bytes`);
  assert.equal(
    await page.textContent('.problems .summary'),
    'The scenario has no mistakes: 12 robots, 2 tasks (hard, easy), 600 s a trial.',
  );
  console.log(`# ready after ${ready.toFixed(0)} ms, ${readFileSync(lab).length} bytes`);
  await done();
});

test('trials are those of the program, to the bit', async () => {
  const { page, done } = await open();
  await run(page, { a: 'RNE', b: 'DIS', seeds: '1..3' });
  const scenario = pathOf('../../scenarios/paper.ron');
  for (const [column, policy] of ['RNE', 'DIS'].entries()) {
    for (const seed of [1, 2, 3]) {
      const args = ['run', scenario, '--policy', policy, '--seed', String(seed), '--json'];
      const record = JSON.parse(execFileSync(usar, args, { encoding: 'utf8', maxBuffer: 1 << 28 }));
      const hashes = await page.$$eval(`.pairs tbody tr:nth-child(${seed}) .hash`, (all) =>
        all.map(({ title }) => title),
      );
      assert.equal(hashes[column], record.state_hash);
      const rescued = await cells(page, seed, 'td.number b');
      assert.equal(rescued[column], String(record.rescuees));
      const energy = record.tasks.reduce((sum, task) => sum + task.energy, record.ungrouped_energy);
      assert.equal((await cells(page, seed, 'td.number'))[3 + column], energy.toFixed(1));
    }
  }
  assert.match(
    await page.textContent('.answer'),
    /RNE less DIS .* over 3 pairs.*So few pairs settle little/s,
  );
  const command = await page.getAttribute('.pairs tbody tr:first-child .commands button', 'title');
  assert.equal(command, 'Copy: usar run scenarios/paper.ron --policy RNE --seed 1 --json');
  await done();
});

test('a mistake is marked within half a second, and the list goes to its line', async () => {
  const { page, done } = await open();
  await cursorBehind(page, 'kind: Aeria');
  await page.evaluate(() => {
    window.marked = new Promise((resolve) => {
      const begin = performance.now();
      const look = () => {
        if (document.querySelector('.problem')) resolve(performance.now() - begin);
        else setTimeout(look, 5);
      };
      document.addEventListener('keydown', look, { once: true, capture: true });
    });
  });
  await page.keyboard.type('x');
  const took = await page.evaluate(() => window.marked);
  assert.ok(took < 500, `${took} ms`);
  console.log(`# marked after ${took.toFixed(0)} ms`);
  assert.match(await page.textContent('.problem'), /^line 47 roles\[2\]\.kind must be one of Ground, Aerial/);
  assert.ok((await page.locator('.cm-lintRange-error').count()) > 0);
  await page.evaluate(() => {
    const { view } = document.querySelector('.cm-content').cmTile;
    view.dispatch({ selection: { anchor: 0 }, scrollIntoView: true });
  });
  await page.click('.problem');
  const line = await page.evaluate(() => {
    const { state } = document.querySelector('.cm-content').cmTile.view;
    return state.doc.lineAt(state.selection.main.head).number;
  });
  assert.equal(line, 47);
  assert.ok(await page.isVisible('.cm-activeLine:has-text("Aeria")'));
  await page.click('[aria-label^="Run all"]');
  await page.waitForTimeout(300);
  assert.match(await status(page), /has mistakes/);
  await done();
});

test('keys that are typed after a pair was shown arrive in the editor, and Ctrl+Enter runs', async () => {
  const { page, done } = await open();
  await shorten(page, 60);
  await choose(page, { seeds: '5' });
  await page.click(editor);
  await page.keyboard.press('Control+Enter');
  await page.waitForFunction(() => document.querySelector('.choices .status').textContent.startsWith('Done'));
  await page.click('.pairs tbody tr');
  await page.waitForSelector('.viewing .stage');
  assert.equal(await page.locator('.viewing .stage').count(), 2);
  assert.match(await page.textContent('.viewing strong'), /^Seed 5: RNE rescued \d+, DIS rescued \d+$/);
  const viewerTime = () => page.evaluate(() => window.usarLab.lab.viewing.viewer.clock.time);
  await page.keyboard.press('ArrowRight');
  assert.equal(await viewerTime(), 1, 'the keys are the viewer’s while it is there');
  assert.equal(await page.evaluate(() => location.hash), '');
  assert.equal(await page.title(), 'usar lab');
  await page.click('[aria-label="Go back to the laboratory"]');
  assert.equal(await page.locator('.viewing .stage').count(), 0);
  await page.click(editor);
  await page.keyboard.press('Control+a');
  const printable = Array.from({ length: 95 }, (_, i) => String.fromCharCode(32 + i)).join('');
  const typed = `// a b[c]${printable}`;
  await page.keyboard.type(typed);
  assert.equal(await text(page), typed);
  await done();
});

test('twenty runs leave one loop of pictures, and none when the viewer is closed', async () => {
  const { page, done } = await open();
  await shorten(page, 60);
  await choose(page, { seeds: '1' });
  let one = 0;
  for (let i = 0; i < 20; i++) {
    await run(page);
    await page.click('.pairs tbody tr');
    await page.waitForSelector('.viewing .stage');
    if (i === 0) one = await picturesASecond(page);
    if (i < 19) await page.click('[aria-label="Go back to the laboratory"]');
  }
  const twenty = await picturesASecond(page);
  assert.ok(one > 20 && twenty < 1.5 * one, `${one} pictures a second at first, ${twenty} after 20 runs`);
  await page.click('[aria-label="Go back to the laboratory"]');
  const none = await picturesASecond(page);
  assert.ok(none <= 2, `${none}`);
  assert.equal(await page.evaluate(() => window.usarLab.running.workers), 1, 'the one that checks');
  console.log(`# pictures a second: ${one} with one viewer, ${twenty} after 20, ${none} without`);
  await done();
});

test('Cancel frees the workers', async () => {
  const { page, done } = await open();
  await shorten(page, 86000);
  await choose(page, { seeds: '1..5' });
  await page.click('[aria-label^="Run all"]');
  await page.waitForFunction(() => window.usarLab.running.workers === 4);
  await page.waitForFunction(() => /%/.test(document.querySelector('.pairs').textContent));
  assert.equal(page.workers().length, 4);
  await page.click('[aria-label="Stop all trials"]');
  await page.waitForFunction(() =>
    document.querySelector('.choices .status').textContent.startsWith('Cancelled'),
  );
  assert.equal(await page.evaluate(() => window.usarLab.running.workers), 1);
  await page.waitForTimeout(200);
  assert.equal(page.workers().length, 1);
  assert.match(await status(page), /0 of 5 pairs/);
  await done();
});

test('a pair is watched while it runs', async () => {
  const { page, done } = await open();
  await shorten(page, 86000);
  await choose(page, { seeds: '1' });
  await page.click('[aria-label^="Run all"]');
  await page.click('.pairs .open:not([disabled])');
  await page.waitForSelector('.viewing .stage');
  assert.match(await page.textContent('.viewing .caption >> nth=0'), /running/);
  assert.match(await page.textContent('.viewing strong'), /RNE is still running/);
  const ends = () => page.evaluate(() => window.usarLab.lab.viewing.viewer.recordings.map(({ end }) => end));
  const early = await ends();
  await page.waitForTimeout(1500);
  const late = await ends();
  assert.ok(late[0] > early[0] && late[1] > early[1], `${early} ${late}`);
  await page.click('[aria-label="Go back to the laboratory"]');
  await page.click('[aria-label="Stop all trials"]');
  await page.waitForFunction(() =>
    document.querySelector('.choices .status').textContent.startsWith('Cancelled'),
  );
  await page.click('.pairs tbody tr');
  await page.waitForSelector('.viewing .stage');
  assert.match(await page.textContent('.viewing .caption >> nth=0'), /cut short/);
  await done();
});

const OWN = 'button[aria-label="Edit your own policy"]';

test('the own policy runs at once', async () => {
  const { page, done } = await open();
  await shorten(page, 120);
  await run(page, { a: 'MINE', b: 'RNE', seeds: '1,2' });
  assert.match(await status(page), /2 of 2 pairs are complete/);
  assert.equal(
    await page.getAttribute('.pairs tbody tr .commands button', 'title'),
    'This policy runs only in this page',
  );
  await page.click('.pairs tbody tr');
  await page.waitForSelector('.viewing .stage');
  assert.ok((await page.textContent('.viewing .caption >> nth=0')).startsWith('MINE'));
  await done();
});

test('a trial that fails says why in its row, and the others go on', async () => {
  const { page, done } = await open();
  await shorten(page, 60);
  await page.click(OWN);
  const sentence = async (code) => {
    await write(page, code);
    await run(page, { a: 'MINE', b: 'DIS', seeds: '1..2' });
    assert.match(await status(page), /0 of 2 pairs/);
    assert.equal((await cells(page, 2, 'td.number b')).length, 1, 'DIS goes on');
    return (await cells(page, 1, '.failed'))[0];
  };
  const nonsense = 'function decide(question) { return question.round > 1 ? 7 : [[0, 1], [99]]; }';
  assert.match(await sentence(nonsense), /the policy failed: .+/);
  assert.match(
    await sentence('const x = 1;\n\nfunction decide() {\n  throw new Error("no idea");\n}'),
    /line 4: Error: no idea/,
  );
  assert.match(await sentence('function decide(question) {\n  return [;\n}'), /line 2: SyntaxError/);
  assert.ok((await page.locator('.cm-lint-marker-error').count()) > 0, 'the line is marked');
  assert.match(await sentence('function other() {}'), /no function "decide"/);
  assert.match(await sentence('function decide() {}'), /returned nothing/);
  await page.click('[aria-label^="Put the original"]');
  assert.match(await text(page), /quotas\[role\]/);
  await done();
});

test('what is old is said to be, and one policy is not compared with itself', async () => {
  const { page, done } = await open();
  await shorten(page, 20);
  await run(page, { seeds: '1' });
  const old = page.locator('.results .few', { hasText: 'have changed since' });
  assert.equal(await old.isVisible(), false);
  const sound = await text(page);
  await write(page, sound.replace('duration_s: 20.0', 'duration: 20.0'));
  await old.waitFor();
  await page.click('[aria-label^="Run all"]');
  await page.waitForFunction(() =>
    /has mistakes/.test(document.querySelector('.choices .status').textContent),
  );
  await write(page, sound.replace('easy', 'near'));
  await page.waitForFunction(() => document.querySelector('.choices .status').textContent === '');
  await choose(page, { a: 'DIS', b: 'DIS' });
  await page.click('[aria-label^="Run all"]');
  assert.match(await status(page), /same policy/);
  assert.equal(await page.evaluate(() => window.usarLab.lab.isEdited), true);
  await done();
});

test('the own policy has no network', async () => {
  let requests = 0;
  const server = createServer((_, response) => {
    requests += 1;
    response.setHeader('Access-Control-Allow-Origin', '*');
    response.end('self.found = true;');
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  const url = `http://127.0.0.1:${server.address().port}/x.js`;
  const { page } = await open();
  await shorten(page, 60);
  await page.click(OWN);
  for (const reach of [
    `const x = new XMLHttpRequest(); x.open("GET", "${url}", false); x.send();`,
    `importScripts("${url}");`,
    `fetch("${url}");`,
    `new WebSocket("${url.replace('http', 'ws')}");`,
    `eval("1");`,
  ]) {
    await write(page, `function decide(question) { ${reach} return []; }`);
    await run(page, { a: 'MINE', b: 'DIS', seeds: '1' });
    assert.match((await cells(page, 1, '.failed'))[0], /policy/);
  }
  assert.equal(requests, 0);
  await page.context().close(); // the browser told of each refusal
  server.close();
});

test('a slider changes its number in the text and nothing else, as one step', async () => {
  const { page, done } = await open();
  const before = await text(page);
  const slider = page.locator('[aria-label="mission.rest_s"]');
  const { x, y, width, height } = await slider.boundingBox();
  await page.mouse.move(x + width * 0.25, y + height / 2);
  await page.mouse.down();
  await page.mouse.move(x + width * 0.4, y + height / 2, { steps: 3 });
  await page.waitForTimeout(700);
  await page.mouse.move(x + width * 0.5, y + height / 2, { steps: 3 });
  await page.mouse.up();
  const value = Number(await slider.inputValue());
  assert.ok(value > 50 && value < 70, `${value}`);
  assert.equal(await text(page), before.replace('rest_s: 30.0', `rest_s: ${value}.0`));
  await slider.press('ArrowRight');
  assert.equal(await text(page), before.replace('rest_s: 30.0', `rest_s: ${value + 1}.0`));
  await page.click(editor);
  await page.keyboard.press('Control+z');
  assert.equal(await text(page), before.replace('rest_s: 30.0', `rest_s: ${value}.0`));
  await page.keyboard.press('Control+z');
  assert.equal(await text(page), before);
  assert.equal(await slider.inputValue(), '30');
  await done();
});

test('a base has a tab, and its mistakes are marked there', async () => {
  const { page, done } = await open();
  await page.selectOption('select', 'gallery/collapse.ron');
  await write(page, '(format: 2, base: "../paper.ron", name: "over", duration_s: 60.0)');
  await page.click('button[aria-label="Edit paper.ron"]');
  assert.match(await text(page), /Yang & Parasuraman/);
  await page.waitForFunction(() => document.querySelector('.summary').textContent.includes('60 s a trial'));
  await cursorBehind(page, 'kind: Aeria');
  await page.keyboard.type('x');
  await page.waitForSelector('.problem');
  await page.click('button[aria-label="Edit gallery/collapse.ron"]');
  await page.click('.problem');
  assert.match(await page.textContent('.cm-activeLine'), /Aeriaxl/);
  await page.keyboard.press('Control+z');
  await page.waitForFunction(() => !document.querySelector('.problem'));
  await run(page, { seeds: '1' });
  const command = await page.getAttribute('.pairs .commands button', 'title');
  assert.equal(command, 'Copy: usar run collapse.ron --policy RNE --seed 1 --json');
  await done();
});

/** Saves what a button gives, and returns its path. */
async function saved(page, label) {
  const [download] = await Promise.all([
    page.waitForEvent('download'),
    page.click(`[aria-label^="${label}"]`),
  ]);
  const path = join(folder, download.suggestedFilename());
  await download.saveAs(path);
  return path;
}

test('a saved page opens with its texts, and can be saved again', async () => {
  const first = await open();
  await write(
    first.page,
    '// <script>alert(1)</script> $& mine\n(format: 2, base: "paper.ron", name: "mine")',
  );
  await first.page.click(OWN);
  await write(first.page, 'function decide() { return "</script><!--"; }');
  await choose(first.page, { a: 'MINE', b: 'ENG', seeds: '7..9' });
  const path = await saved(first.page, 'Save this page');
  await first.done();
  const second = await open({ file: path });
  assert.match(await text(second.page), /^\/\/ <script>alert\(1\)<\/script> \$& mine/);
  assert.equal(await second.page.inputValue('[aria-label="Policy A"]'), 'MINE');
  assert.equal(await second.page.inputValue('[aria-label="Seeds"]'), '7..9');
  const again = readFileSync(await saved(second.page, 'Save this page'), 'utf8');
  assert.equal(again, readFileSync(path, 'utf8'));
  await second.page.click(OWN);
  assert.equal(await text(second.page), 'function decide() { return "</script><!--"; }');
  await second.done();
});

test('the scenario, the table and the recordings can be saved', async () => {
  const { page, done } = await open();
  await shorten(page, 60);
  await run(page, { seeds: '1..2' });
  assert.equal(readFileSync(await saved(page, 'Save the scenario'), 'utf8'), await text(page));
  const table = readFileSync(await saved(page, 'Save the table'), 'utf8')
    .trim()
    .split('\r\n');
  assert.ok(
    table[0].startsWith(
      'scenario,seed,policy_a,rescuees_a,rescuees_a_hard,rescuees_a_easy,energy_a,state_hash_a',
    ),
  );
  assert.equal(table.length, 3);
  assert.match(table[1], /^paper\.ron,1,RNE,\d+,\d+,\d+,[\d.]+,[0-9a-f]{32},,DIS,/);
  await page.click('.pairs tbody tr:nth-child(2)');
  await page.waitForSelector('.viewing .stage');
  const recording = await saved(page, 'Save the recording paper-DIS-2.usrec');
  const said = JSON.parse(execFileSync(usar, ['view', recording, '--at', '60'], { encoding: 'utf8' }));
  assert.equal(said.robots.length, 12);
  await done();
});

test('a shared link opens with its text, and never with code', async () => {
  const context = { permissions: ['clipboard-read', 'clipboard-write'] };
  const first = await open(context);
  await write(first.page, '(format: 2, base: "paper.ron", name: "linked", duration_s: 90.0)');
  await first.page.click(OWN);
  await write(first.page, 'function decide() { return []; }');
  await choose(first.page, { a: 'ENG', b: 'RNE(hard_rule: MeanEnergy)', seeds: '3..4' });
  await first.page.click('[aria-label^="Copy a link"]');
  await first.page.waitForFunction(() => document.querySelector('.said').textContent !== '');
  assert.match(await first.page.textContent('.said'), /^The link is/);
  const hash = await first.page.evaluate(() => location.hash);
  assert.ok(hash.length < 400, `${hash.length}`);
  await first.done();
  const second = await open({ hash });
  assert.equal(await text(second.page), '(format: 2, base: "paper.ron", name: "linked", duration_s: 90.0)');
  assert.equal(await second.page.inputValue('[aria-label="Policy B"]'), 'RNE(hard_rule: MeanEnergy)');
  await second.page.click(OWN);
  assert.match(await text(second.page), /quotas\[role\]/);
  await second.done();
  const third = await open({ hash: '#lab=nonsense!' });
  assert.match(await third.page.textContent('.said'), /^The link cannot be read/);
  const noise = Array.from({ length: 12_000 }, () => Math.random().toString(36)[2]).join('');
  await write(third.page, `// ${noise}`);
  await third.page.click('[aria-label^="Copy a link"]');
  await third.page.waitForFunction(() => document.querySelector('.said').textContent.includes('too long'));
  await third.done();
});

test('every scenario that is carried is without mistakes', async () => {
  const { page, done } = await open();
  const paths = await page.$$eval('select option', (options) => options.map(({ value }) => value));
  assert.ok(paths.length >= 16, `${paths.length}`);
  for (const path of paths) {
    await page.selectOption('select', path);
    await page.waitForTimeout(250);
    assert.match(await page.textContent('.problems .summary'), /^The scenario has no mistakes/, path);
  }
  await done();
});

test('it stands on wide and narrow screens, light and dark', async () => {
  for (const [name, viewport] of [
    ['wide', { width: 1400, height: 900 }],
    ['narrow', { width: 390, height: 844 }],
  ]) {
    for (const colorScheme of ['light', 'dark']) {
      const { page, done } = await open({ viewport, colorScheme });
      await shorten(page, 120);
      await page.click(editor);
      await cursorBehind(page, 'kind: Aeria');
      const shot = async (what) => {
        const sticksOut = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
        assert.ok(sticksOut <= 0, `${what} ${name}: ${sticksOut} pixels stick out`);
        if (!process.env.SHOTS) return;
        await page.screenshot({ path: join(process.env.SHOTS, `${what}-${name}-${colorScheme}.png`) });
        const path = join(process.env.SHOTS, `${what}-${name}-${colorScheme}-full.png`);
        if (name === 'narrow') await page.screenshot({ path, fullPage: true });
      };
      await shot('begin');
      await page.keyboard.type('x');
      await page.waitForSelector('.problem');
      await shot('mistake');
      await page.keyboard.press('Backspace');
      await page.waitForFunction(() => !document.querySelector('.problem'));
      await run(page, { seeds: '1..3' });
      await page.locator('.results').scrollIntoViewIfNeeded();
      await shot('results');
      await page.click('.pairs tbody tr');
      await page.waitForSelector('.viewing .stage');
      await page.waitForTimeout(400);
      await shot('pair');
      await done();
    }
  }
});
