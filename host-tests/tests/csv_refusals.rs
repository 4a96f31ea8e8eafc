//! Every malformed recording is refused with the thing, the place and the remedy.

use tumble::recording::Recording;

const HEADER: &str = "t_s,gx_dps,gy_dps,gz_dps,ax_g,ay_g,az_g\n";

/// Three good lines below the header, at lines 2 to 4.
fn good() -> String {
    format!(
        "{HEADER}0.000,0.1,0.2,0.3,0.01,0.02,1.0\n0.005,0.1,0.2,0.3,0.01,0.02,1.0\n0.010,0.1,0.2,0.3,0.01,0.02,1.0\n"
    )
}

fn refusal(bytes: &[u8]) -> String {
    match Recording::from_bytes(bytes, "rec.csv") {
        Err(error) => error.to_string(),
        Ok(recording) => panic!("accepted {} rows of {:?}", recording.rows.len(), String::from_utf8_lossy(bytes)),
    }
}

/// All of `parts` must be in the message, and a remedy.
fn check(name: &str, bytes: &[u8], parts: &[&str]) {
    let message = refusal(bytes);
    for part in parts.iter().chain(&["rec.csv", "Remedy: "]) {
        assert!(message.contains(part), "{name}: '{part}' is not in: {message}");
    }
}

#[test]
fn wrong_files_and_headers() {
    check("no bytes", b"", &["empty"]);
    check("only remarks", b"# sensor: X\n\n", &["empty"]);
    check("only a header", HEADER.as_bytes(), &["no samples"]);
    check("not text", b"t_s,gx\n0,\xff\xfe\n", &["line 2", "UTF-8", "0xff", "offset 9"]);
    check("column missing", good().replace("gy_dps", "gy").as_bytes(), &["line 1", "gy_dps is missing", "gx_dps, gy,"]);
    check("time missing", good().replace("t_s", "time").as_bytes(), &["t_s is missing", "seconds"]);
    check("semicolons", good().replace(',', ";").as_bytes(), &["t_s is missing", "t_s;gx_dps", "comma-separated"]);
    check("twice", good().replace("gy_dps", "gx_dps").as_bytes(), &["line 1", "gx_dps appears twice"]);
    check("after remarks", format!("# a\n\n# b\n{}", good().replace("az_g", "az")).as_bytes(), &["line 4", "az_g"]);
}

#[test]
fn wrong_lines_and_values() {
    let with = |line: &str| format!("{}{line}\n{}", good(), "0.020,0,0,0,0,0,1\n");
    check("words", with("0.015,0,abc,0,0,0,1").as_bytes(), &["line 5", "column gy_dps", "'abc'", "not a number"]);
    check("nothing", with("0.015,0,,0,0,0,1").as_bytes(), &["line 5", "column gy_dps", "''"]);
    check("decimal comma", with("0,015,0,0,0,0,0,1").as_bytes(), &["line 5", "8 fields", "names 7"]);
    check("NaN", with("0.015,0,0,0,0,NaN,1").as_bytes(), &["line 5", "column ay_g", "'NaN'", "no measurement"]);
    check("infinite", with("0.015,0,0,-inf,0,0,1").as_bytes(), &["line 5", "column gz_dps", "'-inf'"]);
    check("temperature", temperature("warm").as_bytes(), &["line 2", "column temp_c", "'warm'"]);
    check("short", with("0.015,0,0,0,0").as_bytes(), &["line 5", "5 fields", "names 7"]);
    check("same time", with("0.010,0,0,0,0,0,1").as_bytes(), &["line 5", "column t_s", "0.01 s after 0.01 s"]);
    check("time back", with("0.001,0,0,0,0,0,1").as_bytes(), &["line 5", "column t_s", "does not increase"]);
    check("clock wraps", with("1.5,0,0,0,0,0,1\n0.001,0,0,0,0,0,1").as_bytes(), &["line 6", "column t_s", "wraps"]);
    check("below 1 µs", with("0.0100001,0,0,0,0,0,1").as_bytes(), &["line 5", "column t_s", "1 µs"]);
}

fn temperature(value: &str) -> String {
    format!("{},temp_c\n0,0,0,0,0,0,1,{value}\n0.01,0,0,0,0,0,1,20\n", HEADER.trim())
}

#[test]
fn lines_are_counted_through_remarks_and_empty_lines() {
    let text = format!("# sensor: X\n{}# a remark\n\n0.015,0,x,0,0,0,1\n0.02,0,0,0,0,0,1\n", good());
    check("between", text.as_bytes(), &["line 8", "column gy_dps", "'x'"]);
    check("CRLF", text.replace('\n', "\r\n").as_bytes(), &["line 8", "column gy_dps", "'x'"]);
}

#[test]
fn cut_files() {
    let whole = good();
    let cut = whole.trim_end().strip_suffix(",1.0").expect("it ends so");
    check("fields missing", cut.as_bytes(), &["line 4", "ends in the middle", "6 of 7"]);
    let recording = Recording::from_bytes(whole.trim_end().as_bytes(), "rec.csv").expect("usable");
    assert_eq!(recording.rows.len(), 2, "a last number that may be cut is not used");
    assert!(recording.notices[0].contains("last line"), "{:?}", recording.notices);
}

#[test]
fn every_cut_of_a_good_file_is_refused_or_loses_at_most_the_last_line() {
    let whole = good();
    let rows = Recording::from_bytes(whole.as_bytes(), "rec.csv").expect("good").rows;
    for end in 0..whole.len() {
        if let Ok(recording) = Recording::from_bytes(&whole.as_bytes()[..end], "rec.csv") {
            assert!(rows.starts_with(&recording.rows[..recording.rows.len().min(2)]), "cut at {end}");
        }
    }
}

#[test]
fn wrong_metadata() {
    for (line, parts) in [
        ("# turns: sometimes", ["line 1", "'turns'", "fenced or by-hand"]),
        ("# box: round", ["line 1", "'box'", "square or unknown"]),
        ("# gravity_mps2: 1.0", ["line 1", "'gravity_mps2'", "9.7 to 9.9"]),
        ("# rate_hz: fast", ["line 1", "'rate_hz'", "positive"]),
        ("# gyro_range_dps: -250", ["line 1", "'gyro_range_dps'", "positive"]),
        ("# latitude_deg: nan", ["line 1", "'latitude_deg'", "-90 to 90"]),
    ] {
        check(line, format!("{line}\n{}", good()).as_bytes(), &parts);
    }
}

/// Six re-orientations by 90° of 1 s each with 1 s of rest between, at 50 Hz, with the given factors on the columns.
fn tumbling(gyro: f64, accel: f64) -> String {
    let mut text = HEADER.to_string();
    for i in 0..600 {
        let t_s = f64::from(i) * 0.02;
        let (whole, part) = ((t_s / 2.0).floor(), (t_s % 2.0).min(1.0));
        let angle = (whole + part) * std::f64::consts::FRAC_PI_2;
        let rate = if t_s % 2.0 < 1.0 { 90.0 } else { 0.0 };
        let (sin, cos) = angle.sin_cos();
        text += &format!("{t_s},{},0.0,0.0,0.0,{},{}\n", rate * gyro, sin * accel, cos * accel);
    }
    text
}

#[test]
fn wrong_units() {
    assert!(Recording::from_bytes(tumbling(1.0, 1.0).as_bytes(), "rec.csv").is_ok());
    check("m/s²", tumbling(1.0, 9.80665).as_bytes(), &["9.807", "m/s²", "divide ax_g"]);
    check("mg", tumbling(1.0, 1000.0).as_bytes(), &["1000.000", "mg"]);
    check("counts", tumbling(1.0, 2048.0).as_bytes(), &["2048.000", "counts"]);
    check("no gravity", tumbling(1.0, 0.001).as_bytes(), &["without gravity"]);
    check("rad/s", tumbling(1.0_f64.to_radians(), 1.0).as_bytes(), &["rad/s", "57.29578"]);
    for factor in [0.125, 0.5, 2.0, 8.0] {
        let passed = Recording::from_bytes(tumbling(factor, factor).as_bytes(), "rec.csv").is_ok();
        assert!(passed, "a full scale wrong by {factor} is for the diagnosis, not for the reader");
    }
}
