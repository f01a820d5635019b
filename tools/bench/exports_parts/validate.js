// node validate.js FILE...: what Khronos' gltf-validator says about each file, one line of JSON each.
const fs = require('fs');
const validator = require('gltf-validator');

(async () => {
    for (const file of process.argv.slice(2)) {
        const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)));
        const {numErrors, numWarnings, messages} = report.issues;
        const worst = messages.find(message => message.severity === numErrors ? 0 : 1);
        console.log(JSON.stringify({file, errors: numErrors, warnings: numWarnings, says: worst ? worst.code : ''}));
    }
})();
