// How hits of the search are ordered: the pages that explain a thing before those that only mention it.
const LAST = ["CHANGELOG", "CONTRIBUTING", "docs/bad-input"];
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
