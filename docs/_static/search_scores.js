// Guides before recipes and tutorials, these before everything else.
const GUIDES = new Set(
  ("viewer python strategies learning robots legs connect-your-robot " +
    "connect-joints robots-real nao-real obstacles people campaigns " +
    "configuration export walking sensing bound shield evading person games " +
    "unicycles robot-safety how-it-works installation").split(" "));
// Pages of what others mention in a heading too.
const SUBJECTS = new Set(["sensing", "strategies", "walking"]);

var Scorer = {
  score: ([page, title, anchor, description, score]) => {
    const whole = anchor ? 0 : 4;
    if (SUBJECTS.has(page)) return score + 22 + whole;
    if (GUIDES.has(page)) return score + 20 + whole;
    const near = /^(recipe-|tutorials\/)/.test(page);
    return near ? score + 8 + whole : score;
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
