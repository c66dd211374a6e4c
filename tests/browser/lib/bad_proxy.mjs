// A network that drops, delays, doubles, reorders and swallows what goes to the server's /api, by a drawn
// fate each request; everything else goes through. Or one that does what a test says.

import { createServer, request } from "node:http";

/** What stands on the way answers with a page of its own, by any status. */
const foreign = [403, 200, 404, 511];

/**
 * `{url, counts, calm(), rule(fate), close()}`; `seed` decides every fate, and without one there is no
 * storm; `calm` ends it. `fate(method, path, body)` of `rule` goes before: "silent" is never answered, "foreign"
 * by somebody else ("foreign 403" by that status), "damaged" with other bytes; nothing else is changed.
 */
export async function badProxy(target, seed) {
  const { hostname, port } = new URL(target);
  const counts = { lost: 0, unanswered: 0, late: 0, doubled: 0, held: 0, silent: 0, foreign: 0, damaged: 0, whole: 0 };
  let state = seed >>> 0 || 1;
  let stormy = seed !== undefined;
  let rule = () => undefined;
  // xorshift32 (Marsaglia 2003).
  const below = (n) => {
    state ^= state << 13;
    state ^= state >>> 17;
    state ^= state << 5;
    state >>>= 0;
    return state % n;
  };
  const forward = (method, path, headers, body) =>
    new Promise((resolve, reject) => {
      const out = request({ hostname, port, method, path, headers: { ...headers, host: `${hostname}:${port}` } }, (answer) => {
        const parts = [];
        answer.on("data", (part) => parts.push(part));
        answer.on("end", () => resolve({ status: answer.statusCode, headers: answer.headers, body: Buffer.concat(parts) }));
        answer.on("error", reject);
      });
      out.on("error", reject);
      out.end(body);
    });
  const pause = (ms) => new Promise((done) => setTimeout(done, ms));
  const proxy = createServer((incoming, answer) => {
    const parts = [];
    incoming.on("data", (part) => parts.push(part));
    incoming.on("end", async () => {
      const { method, url, headers } = incoming;
      const body = Buffer.concat(parts);
      const drop = () => answer.destroy();
      try {
        const told = rule(method, url, body);
        if (told === "silent") return void counts.silent++;
        if (told?.startsWith("foreign")) {
          const status = Number(told.slice(8)) || foreign[counts.foreign % foreign.length];
          counts.foreign++;
          answer.writeHead(status, { "content-type": "text/html" });
          return answer.end("<!doctype html><title>Please log in</title><p>This network is filtered.</p>");
        }
        if (told === "damaged") {
          counts.damaged++;
          return answer.end("not what was asked for");
        }
        const fate = stormy && url.startsWith("/api/sessions/") ? below(10) : 9;
        if (fate === 0) return (counts.lost++, drop());
        if (fate === 1) {
          // It arrives, and nobody hears of it.
          counts.unanswered++;
          await forward(method, url, headers, body);
          return drop();
        }
        if (fate === 2) (counts.late++, await pause(200 + below(1500)));
        if (fate === 3) (counts.doubled++, await forward(method, url, headers, body));
        if (fate === 4) {
          // The page hears that it failed; the request arrives after those that follow.
          counts.held++;
          setTimeout(() => forward(method, url, headers, body).catch(() => {}), 1000 + below(3000));
          return drop();
        }
        // Held open and never answered: once, as the page waits long for it.
        if (fate === 5 && counts.silent === 0) return void counts.silent++;
        counts.whole++;
        const given = await forward(method, url, headers, body);
        if (answer.destroyed) return;
        answer.writeHead(given.status, given.headers);
        answer.end(given.body);
      } catch {
        drop();
      }
    });
    incoming.on("error", () => {});
  });
  await new Promise((done) => proxy.listen(0, "127.0.0.1", done));
  return {
    url: `http://127.0.0.1:${proxy.address().port}`,
    counts,
    calm: () => (stormy = false),
    rule: (fate) => (rule = fate),
    close: () => (proxy.closeAllConnections(), new Promise((done) => proxy.close(done))),
  };
}
