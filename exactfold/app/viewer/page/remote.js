// Branches and motions on demand, from the server that the page came from.

export async function ask(path) {
  let answer;
  try {
    answer = await fetch(path, { headers: { "X-Exactfold": "1" } });
  } catch {
    throw new Error("the server does not answer: is `exactfold view --serve` still running?");
  }
  const found = await answer.json();
  if (!answer.ok) throw new Error(found.error);
  return found;
}
