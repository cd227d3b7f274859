// NAME: a policy of usar. It answers a question with groups: for each task, the ids of its robots.
//
// node NAME.js --test     asks it the questions of NAME.questions.jsonl

const assert = require("node:assert");
const fs = require("node:fs");
const readline = require("node:readline");

// Per role, the robots with more energy take the harder tasks; ties go to the lower id.
function decide(question, options) {
  const level = question.levels.findIndex((level) => level.name === "energy");
  const energy = (robot) => robot.levels[level] ?? 0;
  const tasks = question.tasks;
  const hardestFirst = tasks.map((_, task) => task).sort((a, b) => tasks[b].difficulty - tasks[a].difficulty);
  const groups = tasks.map(() => []);
  question.quotas.forEach((quota, role) => {
    const robots = question.members.filter((robot) => robot.role === role);
    robots.sort((a, b) => energy(b) - energy(a) || a.id - b.id);
    const ids = robots.map((robot) => robot.id);
    for (const task of hardestFirst) {
      groups[task].push(...ids.splice(0, quota.members[task]));
    }
  });
  return groups;
}

function answer() {
  let options = {};
  // All other prints: console.error(...).
  const send = (message) => process.stdout.write(JSON.stringify(message) + "\n");
  readline.createInterface({ input: process.stdin }).on("line", (line) => {
    const message = JSON.parse(line);
    if (message.type === "hello") {
      options = message.options;
      const hello = { name: "NAME", version: "0.1", deterministic: true };
      send({ type: "hello", protocol: 1, schema_version: 3, ...hello });
    } else if (message.type === "question") {
      const groups = decide(message.question, options);
      send({ type: "decision", id: message.id, decision: { assignment: { groups } } });
    } else {
      process.exit(0);
    }
  });
}

function test() {
  const file = process.argv[1].replace(/\.js$/, "") + ".questions.jsonl";
  const lines = fs.readFileSync(file, "utf8").trim().split("\n");
  for (const line of lines) {
    const question = JSON.parse(line);
    const groups = decide(question, {});
    const ids = question.members.map((robot) => robot.id);
    assert.strictEqual(groups.length, question.tasks.length);
    assert.deepStrictEqual(groups.flat().sort((a, b) => a - b), ids.sort((a, b) => a - b));
  }
  console.log(`${lines.length} questions answered`);
}

process.argv.includes("--test") ? test() : answer();
