// Lets two tabs of one browser keep programs, each with a copy of the shell's own memory.
// node tabs.mjs KEEP: the address of the bundle of `tabs.ts`; prints what was kept, as JSON.

const store = new Map();
const listeners = [];
let writer = -1;
/** The tabs share a storage, and each hears what another one wrote. */
globalThis.localStorage = {
  getItem: (key) => store.get(key) ?? null,
  setItem(key, text) {
    store.set(key, text);
    for (const [tab, listener] of listeners) if (tab !== writer) listener({ key });
  },
};
globalThis.window = { addEventListener: (name, listener) => name === "storage" && listeners.push([writer, listener]) };

const tabs = [];
for (writer = 0; writer < 2; writer++) {
  const tab = await import(`${process.argv[2]}?${writer}`);
  tab.followTabs();
  tabs.push(tab);
}
const texts = (asides) => asides.value.map(({ shared }) => shared.project.files["a.s"]);
const keep = (number, text) => {
  writer = number;
  const { foreignProgram, keepProgram, setAside } = tabs[number];
  const foreign = foreignProgram();
  const isNew = foreign ? setAside(foreign.shared, foreign.tab) : null;
  keepProgram({ project: { main: "a.s", files: { "a.s": text } }, clip: null, machine: "default" });
  return isNew;
};
const found = { told: [] };
for (const [number, text] of [[0, "first"], [0, "first!"], [1, "second"], [0, "first!!"], [1, "second!"], [1, "second!!"]]) {
  found.told.push(keep(number, text));
}
found.kept = JSON.parse(store.get("npchip.program")).project.files["a.s"];
found.asides = tabs.map(({ asides }) => texts(asides));
found.stored = JSON.parse(store.get("npchip.asides")).map(({ shared }) => shared.project.files["a.s"]);
console.log(JSON.stringify(found));
