//! What a user is told about a bad file: row as an editor counts, column, found, allowed.

use stiction_formats::text::{Decimal, Separator, TextOptions, read};

/// A catalogue of bad files, each with the options it is read with.
fn catalogue() -> Vec<(&'static str, Vec<u8>, TextOptions)> {
    let plain = TextOptions::default();
    let mut cases: Vec<(&'static str, Vec<u8>, TextOptions)> = [
        ("empty file", ""),
        ("only blank lines", "\n \r\n\t\n"),
        ("prose", "Dear Sir,\nplease find attached\nthe log.\n"),
        ("header without samples", "time,position\n"),
        ("numbers with units", "1.5mm, 2.5mm\n1.6mm, 2.6mm\n"),
        ("short row", "time;pos\n0;1,5\n1\n2;2,5\n"),
        ("long row", "time;pos\n0;1,5\n1;1,6;7\n2;2,5\n"),
        ("cut-off last row", "time pos vel\n0 1.5 2\n1 1.6 2\n2 1.7"),
        (
            "word among numbers",
            "time [s],torque [Nm]\n0,1.5\n1,ERR\n2,2.5\n",
        ),
        (
            "word in a column without name",
            "0 1.5\n1 #N\n2 2.5\n3 3.5\n",
        ),
        (
            "word in the first sample",
            "time,torque\nERR,1.5\n1,2.5\n2,3.5\n",
        ),
        (
            "row of words among numbers",
            "time,torque\n0,1.5\ntime,torque\n1,2.5\n",
        ),
        ("two decimal marks", "time;pos\n0;1,5\n1;1.6\n"),
        ("grouped digits", "time;pos\n0;1,5\n1;1.600,5\n"),
        (
            "grouped digits with blanks",
            "time;pos\n0;1,5\n1;12 600,5\n",
        ),
        ("comma as separator or decimal mark", "1,234\n5,678\n"),
        ("comma as both", "time,pos\n0,001,1,234\n0,002,1,235\n"),
        ("comma as both, now and then", "time,pos\n0,1\n1,2\n2,2,5\n"),
        ("comma or blanks", "0,5 up 1,5\n0,6 up 1,6\n"),
        ("comma in a time of day", "12:00:00,001\n12:00:00,002\n"),
        ("header with a name too few", "time;pos\n0;1,5;2\n1;1,6;2\n"),
        (
            "header of names and numbers",
            "time;1;2\n0;1,5;2\n1;1,6;2\n",
        ),
        ("column numbers or a sample", "0,1,2\n0.5,1.5,2.5\n"),
        (
            "two units for one column",
            "time [s];pos [mm]\ns;m\n0;1,5\n",
        ),
        (
            "open quote",
            "time,note,pos\n0,\"go,1.5\n1,stop,2.5\n2,go,3\n",
        ),
        (
            "bad date",
            "time,pos\n2024-05-01 10:00:00,1.5\n2024-02-30 10:00:00,2.5\n",
        ),
        (
            "date after times of day",
            "time;pos\n10:00:00,5;1\n2024-05-01 10:00:01;2\n",
        ),
        (
            "dates of unknown order",
            "time;pos\n03/04/2024 10:00:00;1.5\n03/04/2024 10:00:01;1.5\n07/04/2024 10:00:00;2.5\n",
        ),
        (
            "date in another order",
            "time;pos\n26.11.2024 10:00:00;1.5\n11.27.2024 10:00:00;2.5\n26.11.2024 10:00:01;2\n",
        ),
        (
            "date in another form",
            "time;pos\n26/11/2024 10:00:00;1.5\n26/11/2024 10:00:01;2\n11/27/2024 10:00:00;2.5\n26/11/2024 10:00:01;2\n",
        ),
        ("columns of text alone", "name;phase\na;hold\nb;go\n"),
        ("numbers with units, apart", "time;pos\n0 s;1.5 mm\n1 s;1.6 mm\n"),
        ("binary", "PK\u{3}\u{4}\u{14}\0\0\0"),
        (
            "control characters",
            "time,pos\n0,1.5\n1,\u{7}\u{1b}[31mred\n2,2\n",
        ),
        (
            "twincat without samples",
            "Name\tlog\nFile\tc:\\x\n\nName\tx\tName\ty\n",
        ),
        (
            "twincat, names and samples differ",
            "Name\tlog\n\nName\tx\tName\ty\n\n0\t1\t0\n",
        ),
        (
            "twincat, comma as both",
            "Name,log\n\nName,x,Name,y\n\n0,1,0,1\n0,2,1,5,0,2,1,6\n",
        ),
        (
            "twincat, comma as both at once",
            "Name,log\n\nName,x\n\n0,0,1,5\n0,2,1,6\n",
        ),
        (
            "twincat, row grows again",
            "Name\tx\tName\ty\n\n0\t1\t0\t2\n1\t1\n2\t1\t2\t2\n",
        ),
        (
            "twincat, names with blanks",
            "Name log\n\nName x a y b\n\n0 1 2\n1 1 2\n",
        ),
    ]
    .into_iter()
    .map(|(name, text)| (name, text.as_bytes().to_vec(), plain))
    .collect();
    cases.push((
        "late row behind blank lines",
        b"t,x\r\n0,1.5\r\n\r\n# note\r\n1,?!\r\n".into(),
        plain,
    ));
    let many = |n: usize| vec!["1"; n].join(";");
    cases.push((
        "too many columns",
        format!("{0}\n{0}\n", many(4097)).into(),
        plain,
    ));
    cases.push(("a row without end", vec![b'1'; 5 << 20], plain));
    let long = format!("1;2,5\n{}\n", "1".repeat(2 << 20));
    cases.push(("one very long row", long.into(), plain));
    let mut far = "1.5;2\n".repeat(200_000);
    far += "1.5;two\n1.5;2\n";
    cases.push(("far down", far.into(), plain));
    let prose = format!("{}1;2,5\n", "a long story\n".repeat(2000));
    cases.push(("endless preamble", prose.into(), plain));
    let stated = |separator, decimal, header, preamble| TextOptions {
        separator,
        decimal,
        header,
        preamble,
    };
    let comma = Some(Separator::Comma);
    cases.push((
        "comma stated as both",
        b"1,5\n".into(),
        stated(comma, Some(Decimal::Comma), None, None),
    ));
    cases.push((
        "wrong separator stated",
        b"a;b\n0;x1\n".into(),
        stated(comma, None, None, None),
    ));
    cases.push((
        "wrong decimal mark stated",
        b"a;b\n0;1.5\n1;2.5\n".into(),
        stated(None, Some(Decimal::Comma), None, None),
    ));
    cases.push((
        "header stated but of another width",
        b"a title\n0;1,5\n1;2,5\n".into(),
        stated(None, None, Some(true), None),
    ));
    cases.push((
        "preamble stated longer than the file",
        b"0;1,5\n1;2,5\n".into(),
        stated(None, None, None, Some(7)),
    ));
    cases.push((
        "preamble stated too long",
        b"0;1,5\n".into(),
        stated(None, None, None, Some(1001)),
    ));
    cases
}

#[test]
fn every_message_names_place_finding_and_remedy() {
    let mut page = String::new();
    for (name, text, options) in catalogue() {
        let said = match read(&text[..], &options) {
            Ok(table) => panic!("{name}: was read, {:?}", table.detected),
            Err(error) => format!("[{}] {error}", error.kind.code()),
        };
        page += &format!("{name}\n    {said}\n");
    }
    insta::assert_snapshot!(page);
}

#[test]
fn a_file_is_named_in_its_errors() {
    let path = std::env::temp_dir().join("stiction-no-such-log.csv");
    let error = stiction_formats::text::read_file(&path, &TextOptions::default()).unwrap_err();
    assert_eq!(error.kind.code().as_str(), "log-io");
    assert!(
        error.to_string().starts_with(&path.display().to_string()),
        "{error}"
    );
}

#[test]
fn a_source_that_fails_is_an_error() {
    struct Broken;
    impl std::io::Read for Broken {
        fn read(&mut self, _: &mut [u8]) -> std::io::Result<usize> {
            Err(std::io::Error::other("the cable fell out"))
        }
    }
    for rows in [0, 10, 2_000_000] {
        let before = "1.5;2\n".repeat(rows);
        let source = std::io::Read::chain(before.as_bytes(), Broken);
        let error = read(source, &TextOptions::default()).unwrap_err();
        assert_eq!(error.to_string(), "the cable fell out");
    }
}
