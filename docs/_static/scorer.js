// How the search of the site orders its results: pages that people wrote come before the lists of names.
var Scorer = {
  score: ([page, , , , score]) => (page.startsWith("generated/") ? score - 20 : score),
  objNameMatch: 11, objPartialMatch: 6, objPrio: {0: 15, 1: 5, 2: -5}, objPrioDefault: 0,
  title: 15, partialTitle: 7, term: 5, partialTerm: 2,
};
