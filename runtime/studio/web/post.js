// What the module asks of its worker. The copy of the bytes belongs to whoever gets it.
addToLibrary({
  graftal_post: (is_binary, bytes, size) => Module.post(Boolean(is_binary), HEAPU8.slice(bytes, bytes + size)),
});
