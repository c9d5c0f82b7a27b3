// Search by name, by the same rules as view/find.py.

function finder(facts) {
  const bodies = facts.bodies.map((body) => [body.name.toLowerCase(), facts.subjects[body.subject].toLowerCase()]);
  const ports = new Map(Object.entries(facts.ports).map(([bit, mass]) => [bit.toLowerCase(), mass.toLowerCase()]));
  const numbers = (test) => bodies.flatMap(([name, subject], i) => (test(name, subject) ? [i] : []));
  return (text) => {
    const wanted = text.trim().toLowerCase();
    if (!wanted) return [];
    const mass = ports.get(wanted) || wanted;
    const whole = [wanted, `unit ${mass}`, `net ${mass}`, `coupling ${wanted}`, `plate ${wanted}`];
    const exact = numbers((name, subject) => name === wanted || whole.includes(subject));
    return exact.length ? exact : numbers((name, subject) => name.includes(wanted) || subject.includes(wanted));
  };
}

// things to choose from while one types: what bodies belong to, then bodies
function suggestions(facts, text) {
  const wanted = text.trim().toLowerCase();
  if (!wanted) return [];
  const things = facts.subjects.map((subject) => [subject, subject.slice(subject.indexOf(' ') + 1)]);
  const names = facts.bodies.map((body) => [body.name, body.name]);
  return [...things, ...names].filter(([words]) => words.toLowerCase().includes(wanted)).slice(0, 40);
}

// the body whose card says most about what was found: a unit, else a flexure, else the first
function foremost(facts, found) {
  const rank = (number) => {
    const body = facts.bodies[number];
    if (body.name.startsWith('unit.')) return 0;
    return facts.subjects[body.subject].startsWith('coupling ') ? 1 : 2;
  };
  return found.reduce((best, number) => (rank(number) < rank(best) ? number : best), found[0]);
}
