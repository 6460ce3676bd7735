setTimeout(() => {
  throw new Error("on purpose");
});
