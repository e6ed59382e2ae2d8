// Asks each second for the part of the page that changes while something is being run.
const live = document.querySelector("#live");
const lost = document.querySelector("#lost");
const frame = document.querySelector("#frame");
const newer = document.querySelector("#newer");
const points = document.querySelector("#points");

async function refresh() {
  try {
    const answer = await fetch(`${live.dataset.part}?seen=${live.dataset.seen}`);
    if (answer.status === 200) {
      const before = live.querySelector("details");
      live.innerHTML = await answer.text(); // every name in it is escaped by the server
      live.dataset.seen = answer.headers.get("X-Seen");
      if (before !== null) live.querySelector("details")?.toggleAttribute("open", before.open);
      compare();
    }
    lost.hidden = answer.ok;
  } catch {
    lost.hidden = false;
  }
  setTimeout(refresh, 1000);
}

/** Offers what came since the replay, the report or the points were loaded. */
function compare() {
  const now = live.querySelector("[data-version]");
  const seen = frame ?? points;
  if (now === null) return;
  if (frame === null && now.dataset.shown === "yes") location.reload();
  if (newer !== null && seen !== null) newer.hidden = now.dataset.version === seen.dataset.version;
}

/** Loads an experiment's picture, which takes a moment: its trials are counted for it. */
async function count() {
  points.dataset.version = live.querySelector("[data-version]")?.dataset.version;
  try {
    const answer = await fetch(points.dataset.from);
    points.innerHTML = answer.ok ? await answer.text() : ""; // every name in it is escaped by the server
  } catch {
    lost.hidden = false;
  }
}

newer?.addEventListener("click", () => {
  newer.hidden = true;
  if (frame !== null) {
    frame.dataset.version = live.querySelector("[data-version]").dataset.version;
    frame.src = frame.getAttribute("src");
  }
  if (points !== null) count();
});

if (live !== null) setTimeout(refresh, 1000);
if (points !== null) count();
