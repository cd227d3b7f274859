// The page of `usar view` in a browser, from disk: it shows what the recording says, asks for nothing outside, and takes
// every name for text. USAR is the program, CHROMIUM the browser.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { crc32, deflateRawSync, inflateRawSync } from 'node:zlib';
import { chromium } from 'playwright-core';

const usar = process.env.USAR ?? new URL('../../target/release/usar', import.meta.url).pathname;
const executablePath = process.env.CHROMIUM ?? '/usr/bin/chromium';
const scenario = new URL('../../scenarios/paper.ron', import.meta.url).pathname;
const folder = mkdtempSync(join(tmpdir(), 'usar-view-'));
const file = (name) => join(folder, name);
const run = (...args) => execFileSync(usar, args, { cwd: folder, encoding: 'utf8', maxBuffer: 1 << 28 });

let browser;

before(async () => {
  const record = (policy, name) =>
    run('run', scenario, '--policy', policy, '--seed', '3', '--set', 'duration_s=240', '--record', name);
  record('RNE', 'rne.usrec');
  record('DIS', 'dis.usrec');
  run('view', 'rne.usrec', '--no-open', '--out', 'one.html');
  run('view', 'rne.usrec', 'dis.usrec', '--no-open', '--out', 'two.html');
  browser = await chromium.launch({ executablePath, args: ['--no-sandbox', '--disable-gpu'] });
});

after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true });
});

/** Opens a page from disk; every message, error and request to elsewhere is noted. */
async function open(name, options = {}, hash = '') {
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, ...options });
  const page = await context.newPage();
  const complaints = [];
  page.on('console', (message) => complaints.push(`console: ${message.text()}`));
  page.on('pageerror', (error) => complaints.push(`error: ${error.message}`));
  page.on('dialog', (dialog) => complaints.push(`dialog: ${dialog.message()}`));
  page.on('request', (request) => {
    if (request.url().split('#')[0] !== `file://${file(name)}`) complaints.push(`request: ${request.url()}`);
  });
  await page.goto(`file://${file(name)}${hash}`);
  await page.waitForSelector('html[data-ready="yes"]', { timeout: 20_000 });
  const done = async () => {
    assert.deepEqual(complaints, []);
    await context.close();
  };
  return { page, done };
}

/** The facts of the robot panel, by name. */
const facts = (page) =>
  page.$$eval('.robot-panel tr', (rows) =>
    Object.fromEntries(rows.map((row) => [row.children[0].textContent, row.children[1].textContent])),
  );

const words = (name) => name.replaceAll('_', ' ');

test('a robot that is clicked has the values of the recording', async () => {
  const { page, done } = await open('one.html');
  for (const [time, robot] of [
    [30, 0],
    [97.3, 7],
    [151.9, 11],
    [240, 4],
  ]) {
    const said = JSON.parse(run('view', 'rne.usrec', '--at', String(time))).robots[robot];
    await page.keyboard.press('Escape');
    await page.evaluate((to) => window.usarView.seek(to), time);
    await page.waitForTimeout(100);
    // Zoomed in and followed, no other robot is nearer to the click.
    await page.click(`.member[title^="Robot ${robot},"]`);
    await page.keyboard.press('f');
    await page.waitForTimeout(100);
    const place = await page.evaluate((id) => window.usarView.stages[0].placeOf(id), robot);
    await page.mouse.click(1, 1);
    await page.mouse.click(...place);
    await page.waitForTimeout(100);
    const shown = await facts(page);
    assert.equal(await page.textContent('.robot-panel h2'), `Robot ${robot}, ${said.role}`);
    assert.equal(shown.group, said.task ?? 'none');
    assert.equal(shown.energy, `${said.energy.toFixed(1)} %`);
    assert.equal(shown.HP, `${said.hp.toFixed(1)} %`);
    assert.ok(shown.activity.startsWith(words(said.activity)), `${shown.activity} ${said.activity}`);
    assert.ok(shown.delay.startsWith(words(said.delay)), `${shown.delay} ${said.delay}`);
    for (const [need, value] of said.needs) {
      const number = parseFloat(shown[need]);
      assert.ok(
        Math.abs(number - value) <= 0.0006 * Math.max(Math.abs(value), 1),
        `${need} ${number} ${value}`,
      );
    }
    await page.keyboard.press('f');
  }
  await done();
});

test('the timeline is scrubbed, and keys play, step, change the speed and go to rounds', async () => {
  const { page, done } = await open('one.html');
  const time = () => page.evaluate(() => window.usarView.clock.time);
  const { x, y, width } = await page.locator('.timeline-canvas').boundingBox();
  await page.mouse.move(x + 0.1 * width, y + 10);
  await page.mouse.down();
  await page.mouse.move(x + 0.5 * width, y + 10, { steps: 8 });
  await page.mouse.up();
  assert.ok(Math.abs((await time()) - 120) < 3, `${await time()}`);
  await page.waitForTimeout(60);
  assert.equal((await page.textContent('.time')).split(' / ')[1], '4:00.0');
  const before = await time();
  await page.keyboard.press('ArrowRight');
  await page.keyboard.press('Shift+ArrowLeft');
  assert.ok(Math.abs((await time()) - (before - 9)) < 1e-6);
  await page.keyboard.press('+');
  await page.keyboard.press('+');
  await page.keyboard.press(' ');
  await page.waitForTimeout(600);
  await page.keyboard.press(' ');
  assert.ok((await time()) > before - 9 + 5, 'it played at 20 times');
  const stopped = await time();
  await page.waitForTimeout(100);
  assert.equal(await time(), stopped);
  await page.keyboard.press('Home');
  await page.keyboard.press(']');
  assert.ok((await time()) > 20, 'the second round');
  await page.waitForTimeout(60);
  assert.equal(await page.textContent('.round-panel h2'), 'Round 2');
  await page.keyboard.press('?');
  assert.ok(await page.isVisible('dialog.help'));
  await page.keyboard.press('?');
  assert.ok(!(await page.isVisible('dialog.help')));
  await done();
});

test('two recordings go in step, and what a group knows can be shown', async () => {
  const { page, done } = await open('two.html', { colorScheme: 'dark' });
  assert.equal(await page.locator('.stage').count(), 2);
  const picture = () => page.$eval('.stage-canvas', (canvas) => canvas.toDataURL());
  await page.evaluate(() => window.usarView.seek(60));
  await page.waitForTimeout(60);
  const world = await picture();
  await page.click('.chip:has-text("home")');
  await page.waitForTimeout(60);
  assert.notEqual(await picture(), world);
  await page.click('.tabs button:nth-child(2)');
  await page.click('.member[title^="Robot 2,"]');
  const said = JSON.parse(run('view', 'dis.usrec', '--at', '60')).robots[2];
  assert.equal((await facts(page)).energy, `${said.energy.toFixed(1)} %`);
  await done();
});

test('a phone shows it, and fingers zoom', async () => {
  const { page, done } = await open('one.html', { viewport: { width: 390, height: 844 }, hasTouch: true });
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= 390), 'nothing sticks out');
  const scale = () => page.evaluate(() => window.usarView.stages[0].camera.scale);
  const fitted = await scale();
  await page.$eval('.stage-canvas', (canvas) => {
    canvas.setPointerCapture = () => undefined; // of fingers that are not there
    const { left, top } = canvas.getBoundingClientRect();
    const finger = (type, pointerId, x, y) =>
      canvas.dispatchEvent(new PointerEvent(type, { pointerId, clientX: left + x, clientY: top + y }));
    finger('pointerdown', 7, 100, 100);
    finger('pointerdown', 8, 140, 100);
    for (let x = 150; x <= 220; x += 10) finger('pointermove', 8, x, 100);
    finger('pointerup', 7, 100, 100);
    finger('pointerup', 8, 220, 100);
  });
  assert.ok((await scale()) > 2 * fitted);
  await done();
});

test('a link opens a moment with its totals, the address follows, and a field asks for a time', async () => {
  const { page, done } = await open('two.html', {}, '#t=128&robot=4');
  await page.waitForTimeout(100);
  assert.equal(await page.textContent('.robot-panel h2'), 'Robot 4, carrier');
  assert.match(await page.textContent('.time'), /^2:08\.0/);
  const rescued = (name, time) => {
    const { rescuees } = JSON.parse(run('view', name, '--at', String(time)));
    return `${rescuees.find(([state]) => state === 'delivered')[1]} rescued`;
  };
  const totals = () => page.locator('.total').allTextContents();
  assert.deepEqual(
    await totals(),
    ['rne.usrec', 'dis.usrec'].map((name) => rescued(name, 128)),
  );
  const hash = () => page.evaluate(() => location.hash);
  await page.keyboard.press('ArrowRight');
  await page.keyboard.press('Escape');
  await page.waitForTimeout(100);
  assert.equal(await hash(), '#t=129');
  await page.click('.time');
  await page.keyboard.type('1:00');
  await page.keyboard.press('Enter');
  await page.waitForTimeout(100);
  assert.equal(await hash(), '#t=60');
  await page.keyboard.press('g');
  await page.keyboard.type('3:20');
  await page.keyboard.press('Enter');
  await page.waitForTimeout(100);
  assert.equal(await hash(), '#t=200');
  assert.deepEqual(
    await totals(),
    ['rne.usrec', 'dis.usrec'].map((name) => rescued(name, 200)),
  );
  await page.evaluate(() => (location.hash = '#t=60&robot=7'));
  await page.waitForTimeout(100);
  assert.equal(await page.textContent('.robot-panel h2'), 'Robot 7, supplier');
  assert.ok((await page.locator('.course tr').count()) > 0, 'its own timeline');
  await done();
});

test('a folder of results is one page that lists its trials', async () => {
  const policies = [
    '--policies',
    'RNE,DIS',
    '--trials',
    '2',
    '--set',
    'duration_s=120',
    '--recordings',
    'all',
  ];
  run('sweep', scenario, ...policies, '--quiet', '--out', 'results');
  run('view', 'results', '--with-replays', '--no-open', '--out', 'all.html');
  const { page, done } = await open('all.html');
  assert.deepEqual(await page.locator('.caption strong').allTextContents(), ['RNE', 'DIS']);
  await page.waitForFunction(() => !document.querySelector('.trials').textContent.includes('…'));
  const last = page.locator('.trials a[title="Show DIS, seed 2"]');
  const rescued = await last.textContent();
  await page.evaluate(() => window.usarView.seek(120));
  await page.waitForTimeout(100);
  await last.click();
  await page.waitForSelector('.stage >> nth=0');
  await page.waitForFunction(() => document.querySelectorAll('.stage').length === 1);
  await page.waitForSelector('html[data-ready="yes"]');
  await page.waitForTimeout(100);
  assert.ok((await page.textContent('.caption')).startsWith(`DIS ${rescued} rescued`));
  assert.equal(await page.evaluate(() => location.hash), '#trials=DIS-2&t=120');
  await done();
});

/** The same recording with its chunks of JSON edited: for each kind of chunk, what changes its value. */
function edited(bytes, edits) {
  const parts = [bytes.subarray(0, 8)];
  for (let at = 8; at < bytes.length;) {
    const head = Buffer.from(bytes.subarray(at, at + 20));
    let content = bytes.subarray(at + 20, at + 20 + head.readUInt32LE(4));
    at += 20 + content.length;
    const edit = edits[head.toString('latin1', 0, 4)];
    if (edit) {
      const value = JSON.parse(inflateRawSync(content).toString());
      edit(value);
      const text = Buffer.from(JSON.stringify(value));
      content = deflateRawSync(text);
      head.writeUInt32LE(content.length, 4);
      head.writeUInt32LE(text.length, 8);
      head.writeUInt32LE(crc32(content), 12);
      head.writeUInt32LE(crc32(head.subarray(0, 16)), 16);
    }
    parts.push(head, content);
  }
  return Buffer.concat(parts);
}

test('hostile names are shown as text', async () => {
  const evil = '<img src=x onerror=alert(1)><script>alert(2)</script>"\'&';
  const ask = ({ question }) => {
    for (const task of question.tasks) task.name = evil;
    question.roles.fill(evil);
  };
  const bytes = edited(readFileSync(file('rne.usrec')), {
    HEAD: (header) => {
      header.policy = header.scenario.name = header.scenario.description = header.program = evil;
      for (const role of header.world.roles) role.name = evil;
      for (const task of header.world.tasks) task.name = evil;
      for (const need of header.world.needs) need.name += evil;
    },
    DECI: ask,
    DONE: (record) => {
      for (const task of record.tasks) task.task = evil;
      for (const robot of record.robots) robot.role = evil;
      record.decisions.forEach(ask);
    },
  });
  const name = '<img src=x onerror=alert(3)>.usrec';
  writeFileSync(file(name), bytes);
  run('view', name, '--no-open', '--out', 'evil.html');
  const { page, done } = await open('evil.html');
  await page.click('.member >> nth=3');
  await page.keyboard.press(']');
  await page.waitForTimeout(100);
  assert.equal(await page.locator('img, #app script').count(), 0);
  for (const place of ['.caption', '.robot-panel h2', '.about', '.chip >> nth=1']) {
    assert.ok((await page.textContent(place)).includes(evil), place);
  }
  assert.ok((await facts(page))[`hp${evil}`]);
  await done();
});

test('a recording that is damaged or cut is told of', async () => {
  const bytes = readFileSync(file('rne.usrec'));
  writeFileSync(file('cut.usrec'), bytes.subarray(0, Math.floor(bytes.length / 2)));
  run('view', 'cut.usrec', '--no-open', '--out', 'cut.html');
  const { page, done } = await open('cut.html');
  assert.ok((await page.textContent('.caption')).includes('cut short'));
  await done();
  const page2 = await browser.newPage();
  const whole = readFileSync(file('one.html'), 'utf8');
  writeFileSync(file('broken.html'), whole.replace(/(\.usrec">.{40000}).{4}/, '$1AAAA'));
  await page2.goto(`file://${file('broken.html')}`);
  await page2.waitForSelector('h1');
  assert.ok((await page2.textContent('.message')).includes('is damaged: chunk'));
});
