// node validate.js FILE...: what Khronos' gltf-validator says about each file, one line of JSON each.
const fs = require('fs');
const validator = require('gltf-validator');

(async () => {
    for (const file of process.argv.slice(2)) {
        const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)));
        const {numErrors, numWarnings, messages} = report.issues;
        const worst = messages.reduce((a, b) => (b.severity < a.severity ? b : a), {code: '', severity: 9});
        console.log(JSON.stringify({file, errors: numErrors, warnings: numWarnings, says: worst.code}));
    }
})();
