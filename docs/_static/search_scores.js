// Guides before recipes and tutorials, these before everything else.
const GUIDES = new Set(
  ("viewer python strategies learning robots legs connect-your-robot " +
    "connect-joints robots-real nao-real obstacles people campaigns " +
    "configuration export walking sensing bound shield evading person games " +
    "unicycles robot-safety how-it-works installation").split(" "));
// Pages of what others mention in a heading too.
const SUBJECTS = new Set(["sensing", "strategies", "walking"]);
// Beginnings of the words asked for, without endings such as -ies.
const ASKED = (new URLSearchParams(location.search).get("q") || "")
  .toLowerCase().split(/\s+/).filter((word) => word)
  .map((word) => word.slice(0, Math.max(4, word.length - 2)));

var Scorer = {
  score: ([page, title, anchor, description, score]) => {
    const named = ASKED.every((word) => title.toLowerCase().includes(word));
    const whole = (anchor ? 0 : 4) + (named && !anchor ? 26 : 0);
    if (SUBJECTS.has(page)) return score + 22 + whole;
    if (GUIDES.has(page)) return score + 20 + whole;
    const near = /^(recipe-|tutorials\/)/.test(page);
    return score + whole + (near ? 8 : 0);
  },
  objNameMatch: 4,
  objPartialMatch: 2,
  objPrio: {0: 3, 1: 1, 2: -5},
  objPrioDefault: 0,
  title: 15,
  partialTitle: 7,
  term: 5,
  partialTerm: 2,
};
