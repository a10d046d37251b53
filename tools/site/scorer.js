// How hits of the search are ordered: the users' pages before those of the maintainers and what only mentions a thing.
const LAST = ["docs/solver", "CONTRIBUTING", "docs/release", "SECURITY", "CHANGELOG", "docs/bad-input"];
var Scorer = {
  score: ([page, title, anchor, description, score]) => (LAST.includes(page) ? score - 100 : score),
  objNameMatch: 11,
  objPartialMatch: 6,
  objPrio: { 0: 15, 1: 5, 2: -5 },
  objPrioDefault: 0,
  title: 15,
  partialTitle: 7,
  term: 5,
  partialTerm: 2,
};
