// The server that the page came from: it answers in lines, as soon as it knows something.

export function createServer() {
  const session = crypto.randomUUID();
  const running = new Map();

  // Each line of the answer in turn. A new request of a kind ends the one before.
  async function lines(path, body, take) {
    running.get(path)?.abort();
    const ended = new AbortController();
    running.set(path, ended);
    let answer;
    try {
      answer = await fetch(path, { method: "POST", headers: { "X-Exactfold": "1" }, body: JSON.stringify({ ...body, session }), signal: ended.signal });
    } catch (error) {
      if (error.name === "AbortError") throw error;
      throw new Error("the server does not answer: is `exactfold serve` still running?");
    }
    if (!answer.ok) throw new Error(await answer.text());
    const reader = answer.body.pipeThrough(new TextDecoderStream()).getReader();
    let rest = "";
    for (;;) {
      const { value, done } = await reader.read();
      if (done) return;
      const parts = (rest + value).split("\n");
      rest = parts.pop();
      for (const text of parts) {
        const line = text ? JSON.parse(text) : null;
        if (line && line.kind !== "done" && !ended.signal.aborted) take(line);
      }
    }
  }

  // The only line of an answer.
  async function one(path, body) {
    let found = null;
    await lines(path, body, (line) => {
      if (line.kind === "error") throw new Error(line.error);
      found = line;
    });
    if (!found) throw new Error("the server gave no answer");
    return found;
  }

  return { lines, one, stop: (path) => running.get(path)?.abort() };
}
