//! Values of scene files that make no sense: refused by key and value, one fault each.

use crate::scene_keys::{BEAM, BODIES, LOADS, SITTING, faults, read};

/// Replaces a text by a wrong one and expects one fault with these words.
fn assert_refused(text: &str, changes: &[(&str, &str, &str)]) {
    read(text);
    for (sound, wrong, words) in changes {
        assert!(text.contains(sound), "{sound}");
        let found = faults(&text.replacen(sound, wrong, 1));
        assert!(found.len() == 1 && found[0].contains(words), "`{words}`: {found:#?}");
    }
}

#[test]
fn values_that_make_no_sense_are_refused_by_key_and_value() {
    assert_refused(
        &[BODIES, LOADS].concat(),
        &[
            (
                "direction = [0, 3, 4]",
                "direction = [0, 0, 0]",
                "`forces.push.direction`: its length 0 must be",
            ),
            (
                "direction = [0, 3, 4]",
                "direction = [nan, 0, 0]",
                "`forces.push.direction`: its length NaN must be",
            ),
            (
                "frequency = 3",
                "frequency = inf",
                "`forces.push.drives[0].harmonic.frequency`: frequency = inf must be",
            ),
            (
                "[2, 0]]",
                "[0, 0]]",
                "`forces.push.drives[2].table.points`: node = 0 must be a node behind the one before",
            ),
            (
                "torque = 5",
                "torque = nan",
                "`moments.twist.drives[0].constant.torque`: torque = NaN must be",
            ),
            (
                "axes = \"link\"",
                "axes = \"lonk\"",
                "`forces.push.axes`: there is no word `lonk`; did you mean `link`?",
            ),
            (
                "at = { link = \"two\"",
                "at = { link = \"twa\"",
                "`forces.push.at.link`: there is no link `twa`; did you mean `two`?",
            ),
            (
                "at.link = \"one\"",
                "at.point = [0, 0, 1]",
                "`moments.twist.at`: is on the ground, where it does nothing",
            ),
            (
                "at = { link = \"two\"",
                "at = { end = true, link = \"two\"",
                "`forces.push.at.end`: only a beam has an end",
            ),
            (
                "to = { link = \"two\"",
                "to = { link = \"ground\"",
                "`struts.spring.to`: is on the same link as `from`",
            ),
            (
                "free_length = 0.5",
                "free_length = -0.5",
                "`struts.spring.free_length`: free_length = -0.5 must be",
            ),
            (
                "stiffness = 100",
                "stiffness = nan",
                "`struts.spring.stiffness`: stiffness = NaN must be",
            ),
            (
                "damping = 3",
                "damping = -3",
                "`struts.spring.damping`: damping = -3 must be",
            ),
            (
                "[moments.twist]",
                "[moments.push]",
                "`moments.push`: the name `push` is used twice",
            ),
            (
                "[struts.spring]",
                "[struts.push]",
                "`struts.push`: the name `push` is used twice",
            ),
            (
                "[struts.spring]",
                "[struts.twist]",
                "`struts.twist`: the name `twist` is used twice",
            ),
        ],
    );
    // Joints and links are other things than loads and may be called alike.
    read(&[BODIES, &LOADS.replace("spring", "A").replace("twist", "one")].concat());
    assert_refused(
        SITTING,
        &[
            (
                "lower = \"-90 deg\"",
                "lower = 2",
                "`joints.A.limit`: the stops 2 and 1 must be finite, the lower below the upper",
            ),
            (
                "lower = \"-90 deg\", upper = 1,",
                "",
                "`joints.A.limit`: give a lower stop, an upper stop or both",
            ),
            ("upper = 0.2", "upper = nan", "`joints.C.limit`: the stops"),
            (
                "stiffness = 1e4",
                "stiffness = 0",
                "`joints.A.limit.contact`: stiffness is 0",
            ),
            (
                "exponent = 2",
                "exponent = 0.5",
                "`joints.C.limit.contact`: exponent is 0.5",
            ),
            (
                "least_impact_speed = 1e-4",
                "least_impact_speed = 0",
                "`joints.C.limit.contact`: least_impact_speed is 0",
            ),
            (
                "rest = \"90 deg\"",
                "rest = inf",
                "`joints.A.springs[0].rest`: rest = inf must be",
            ),
            (
                "rest = \"90 deg\"",
                "rest = \"90 dog\"",
                "`joints.A.springs[0].rest`: must be a number or degrees like \"30 deg\"",
            ),
            ("lead = 0.01", "lead = nan", "`joints.B.lead`: NaN"),
            ("lead = 0.01", "", "`joints.B`: a screw needs its `lead`"),
            (
                "kind = \"prismatic\"",
                "kind = \"prismatic\"\nlead = 1",
                "`joints.C.lead`: 1",
            ),
            (
                "coefficients = [0.5, 1, -2]",
                "coefficients = []",
                "`joints.B.prescribed.polynomial.coefficients`: coefficients = 0 must be at least one coefficient",
            ),
            (
                "coefficients = [0.5, 1, -2]",
                "coefficients = [inf]",
                "`joints.B.prescribed.polynomial.coefficients`: coefficient = inf must be",
            ),
            (
                "frequency = 2",
                "frequency = nan",
                "`joints.A.prescribed.harmonic.frequency`: frequency = NaN must be",
            ),
            (
                "speeds = { points = [[0, 1], [1, 2], [2, 0]] }",
                "speeds = { points = [[0, 1]] }",
                "`joints.C.prescribed.speeds.points`: nodes = 1 must be at least two nodes",
            ),
            (
                "table = { points = [[0, 1], [1, 2]",
                "table = { points = [[0, 1], [1]",
                "`joints.D.prescribed.table.points[1]`: must have 2 entries, not 1",
            ),
            (
                "harmonic = {",
                "harmonik = {",
                "there is no key `harmonik`; did you mean `harmonic`?",
            ),
        ],
    );
    assert_refused(
        BEAM,
        &[
            (
                "elements = 3",
                "elements = 0",
                "`links.beam.beam.elements`: 0 must lie between 1 and 500",
            ),
            (
                "size = [0.1, 0.1, 0.1]",
                "size = [0.1, 0, 0.1]",
                "`links.tip.box.size`: 0 must be",
            ),
            (
                "predecessor = { link = \"beam\", end",
                "predecessor = { link = \"ground\", end",
                "`joints.B.predecessor.end`: only a beam has an end",
            ),
            (
                "relaxation_time = 1e-4",
                "relaxation_time = -1",
                "`links.beam.beam.relaxation_time`: material.relaxation_time is -1",
            ),
            ("height = 0.02", "height = 0", "`links.beam.beam.section`: height is 0"),
            (
                "until = 3",
                "until = -3",
                "`run.until`: -3 s must be a finite positive number",
            ),
            (
                "every = 0.1",
                "every = 0",
                "`run.every`: 0 s must be a finite positive number",
            ),
            (
                "step = 1e-3",
                "step = nan",
                "`run.step`: NaN s must be a finite positive number",
            ),
            ("step = 1e-3", "rtol = 1e-3", "`run.rtol`: does not go with the method"),
            (
                "method = \"newmark\"",
                "method = \"newmarc\"",
                "`run.method`: there is no word `newmarc`; did you mean `newmark`?",
            ),
            (
                "crank = \"B.psi\"",
                "crank = \"B.psy\"",
                "`run.crank`: there is no coordinate `B.psy`; did you mean `B.psi`?",
            ),
            (
                "\"sway.3\"",
                "\"sway.4\"",
                "`start.speeds.sway.4`: there is no coordinate `sway.4`",
            ),
            (
                "[links.tip.box]",
                "[links.\"beam,1\"]\nmass = 1\n[joints.C]\nkind = \"revolute\"\nsuccessor.link = \"beam,1\"\n[links.tip.box]",
                "the name `beam,1` is used twice",
            ),
            (
                "[joints.A]",
                "[joints.\"beam.2\"]",
                "`joints.beam.2`: the name `beam.2` is used twice",
            ),
        ],
    );
    let second = BEAM.replace("elements = 3", "elements = 300")
        + "[links.more.beam]\nlength = 1\nsection.circle.diameter = 0.1\n\
        density = 1000\nyoungs_modulus = 1e9\npoissons_ratio = 0.3\nelements = 200\n[joints.more]\nkind = \"fixed\"\nsuccessor.link = \"more\"\n";
    assert_refused(
        &second,
        &[(
            "elements = 200",
            "elements = 201",
            "`links.more.beam.elements`: makes 501 elements in all beams up to here, more than 500",
        )],
    );
}
