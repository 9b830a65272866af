//! Addresses as they are typed.

use proptest::prelude::*;
use stiction_record::{Device, Error};

fn device(words: &[&str]) -> String {
    match Device::parse(words) {
        Ok(Device::Rtde { host, port }) => format!("rtde {host} {port}"),
        Ok(Device::Ads {
            host,
            port,
            net_id,
            ams_port,
            symbols,
        }) => {
            let symbols = symbols.iter().map(|s| match &s.unit {
                Some(unit) => format!("{} in {unit}", s.name),
                None => s.name.clone(),
            });
            let symbols: Vec<_> = symbols.collect();
            format!(
                "ads {host} {port} {net_id} {ams_port} {}",
                symbols.join(", ")
            )
        }
        Err(Error::Usage { .. }) => "usage".into(),
        Err(e) => panic!("{e}"),
    }
}

/// Before anything is connected or written.
#[test]
fn a_time_that_is_none_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("log.csv");
    for time in [0.0, -1.0, f64::NAN, f64::NEG_INFINITY] {
        let refused = super::recorded(&["rtde://127.0.0.1:1".into()], 500.0, time, &out);
        assert!(matches!(refused, Err(Error::Usage { .. })), "{refused:?}");
    }
    assert!(!out.exists());
}

#[test]
fn an_address_names_host_ports_and_symbols() {
    for (words, read) in [
        (&["rtde://192.168.0.5"][..], "rtde 192.168.0.5 30004"),
        (&["rtde://ur5e.local:4000/"], "rtde ur5e.local 4000"),
        (&["rtde://[fe80::1]:4000"], "rtde fe80::1 4000"),
        (
            &["ads://5.12.34.56.1.1:851/MAIN.x"],
            "ads 5.12.34.56 48898 5.12.34.56.1.1 851 MAIN.x",
        ),
        (
            &["ads://5.12.34.56.1.1:851@plc:1/MAIN.a[1,2]", "G.v=mm/s"],
            "ads plc 1 5.12.34.56.1.1 851 MAIN.a[1,2], G.v in mm/s",
        ),
        (&["rtde://"], "usage"),
        (&["rtde://a b"], "usage"),
        (&["rtde://robot:70000"], "usage"),
        (&["rtde://robot", "x"], "usage"),
        (&["ads://5.12.34.56.1:851/x"], "usage"),
        (&["ads://5.12.34.56.1.1/x"], "usage"),
        (&["ads://5.12.34.56.1.1:851"], "usage"),
        (&["ads://5.12.34.56.1.1:851/x", "x"], "usage"),
        (
            &["ads://5.12.34.56.1.1:851/x", "ads://5.12.34.56.1.1:851/y"],
            "usage",
        ),
        (&["http://host"], "usage"),
        (&["log.csv"], "usage"),
        (&[], "usage"),
    ] {
        assert_eq!(device(words), read, "{words:?}");
    }
}

#[test]
fn a_rate_has_its_limits() {
    let rate = |url: &str, rate| {
        Device::parse(&[url])
            .unwrap()
            .source(rate)
            .map(|s| s.rate())
    };
    assert_eq!(rate("rtde://a", None).unwrap(), 125.0);
    assert_eq!(rate("ads://1.2.3.4.1.1:851/x", None).unwrap(), 1000.0);
    for (url, hertz) in [
        ("rtde://a", 501.0),
        ("rtde://a", 0.5),
        ("ads://1.2.3.4.1.1:851/x", f64::NAN),
    ] {
        assert!(matches!(rate(url, Some(hertz)), Err(Error::Usage { .. })));
    }
}

proptest! {
    #[test]
    fn any_text_is_an_address_or_a_usage_error(words in prop::collection::vec("(ads|rtde|://|[0-9.:@/=a]|\\PC){0,12}", 0..4)) {
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        device(&words);
    }
}
