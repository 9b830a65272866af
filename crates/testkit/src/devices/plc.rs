//! A PLC that speaks ADS.

use super::{Script, Served, Server, value};
use std::io::Write;
use std::net::SocketAddr;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Time stamp of the first sample, 100 ns since 1601.
const BEGIN: u64 = 133_801_632_000_000_123;
/// Samples that are sent in one notification.
const GATHERED: usize = 7;

/// A variable and its type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Variable {
    Lreal(&'static str),
    Real(&'static str),
    Dint(&'static str),
    Bool(&'static str),
    Text(&'static str),
}

impl Variable {
    fn name(self) -> &'static str {
        match self {
            Variable::Lreal(name)
            | Variable::Real(name)
            | Variable::Dint(name)
            | Variable::Bool(name)
            | Variable::Text(name) => name,
        }
    }

    /// Number of the type in ADS, and its size.
    fn kind(self) -> (u32, u32) {
        match self {
            Variable::Lreal(_) => (5, 8),
            Variable::Real(_) => (4, 4),
            Variable::Dint(_) => (3, 4),
            Variable::Bool(_) => (33, 1),
            Variable::Text(_) => (30, 81),
        }
    }

    /// Its value as sent, and as a number.
    fn value(self, sample: usize, column: usize) -> (Vec<u8>, f64) {
        let value = value(sample, column);
        match self {
            Variable::Lreal(_) => (value.to_le_bytes().into(), value),
            Variable::Real(_) => ((value as f32).to_le_bytes().into(), f64::from(value as f32)),
            Variable::Dint(_) => {
                let whole = (1e9 * value) as i32;
                (whole.to_le_bytes().into(), f64::from(whole))
            }
            Variable::Bool(_) => (
                vec![u8::from(value > 0.0)],
                f64::from(u8::from(value > 0.0)),
            ),
            Variable::Text(_) => (vec![0; 81], f64::NAN),
        }
    }
}

/// The server; it ends with the value.
pub struct Plc {
    server: Server,
    forgotten: Arc<AtomicUsize>,
    variables: Vec<Variable>,
    rate: f64,
}

struct State {
    forgotten: Arc<AtomicUsize>,
    variables: Vec<Variable>,
    rate: f64,
    script: Script,
    next: usize,
}

impl Plc {
    /// Starts a PLC whose task has a rate in Hz. Samples come once every variable is asked for.
    pub fn start(variables: &[Variable], rate: f64, script: Script) -> Self {
        let forgotten = Arc::new(AtomicUsize::new(0));
        let mut state = State {
            forgotten: forgotten.clone(),
            variables: variables.to_vec(),
            rate,
            script,
            next: 0,
        };
        let server = Server::start(move |served| state.serve(served));
        Self {
            server,
            forgotten,
            variables: variables.to_vec(),
            rate,
        }
    }

    /// Where it listens.
    pub fn at(&self) -> SocketAddr {
        self.server.at
    }

    /// Commands that it refused; waits until no client is connected.
    pub fn refused(&self) -> Vec<String> {
        self.server.refused()
    }

    /// Notifications that were ended; waits as [`Plc::refused`] does.
    pub fn forgotten(&self) -> usize {
        self.server.refused();
        self.forgotten.load(Ordering::SeqCst)
    }

    /// Time of a sample after the first, s.
    pub fn time(&self, sample: usize) -> f64 {
        ticks(sample, self.rate) as f64 / 1e7
    }

    /// The value of a variable in a sample.
    pub fn value(&self, sample: usize, variable: usize) -> f64 {
        self.variables[variable].value(sample, variable).1
    }
}

fn ticks(sample: usize, rate: f64) -> u64 {
    (sample as f64 * 1e7 / rate).round() as u64
}

fn number(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(bytes[at..at + 4].try_into().expect("four bytes"))
}

impl State {
    fn serve(&mut self, mut served: Served) -> bool {
        let mut asked = Vec::new();
        loop {
            let Some(head) = served.read(6) else {
                return true;
            };
            let Some(request) = served.read(number(&head, 2) as usize) else {
                return true;
            };
            let (header, data) = request.split_at(32);
            let command = u16::from_le_bytes([header[16], header[17]]);
            let answer = match command {
                9 if number(data, 0) == 0xF009 => self.look_up(&data[16..]),
                6 => {
                    // Which variable stands in the offset, mode 3 is each cycle, times are in 100 ns.
                    let variable = number(data, 4) as usize;
                    let cycle = (1e7 / self.rate).round() as u32;
                    let (_, size) = self.variables[variable].kind();
                    if (number(data, 8), number(data, 12), number(data, 20)) != (size, 3, cycle) {
                        served.refuse(format!("a notification of {data:?}"));
                    }
                    asked.push(variable);
                    [0_u32, 100 + variable as u32]
                        .iter()
                        .flat_map(|n| n.to_le_bytes())
                        .collect()
                }
                7 => {
                    self.forgotten.fetch_add(1, Ordering::SeqCst);
                    0_u32.to_le_bytes().to_vec()
                }
                _ => {
                    served.refuse(format!("ADS command {command} with {data:?}"));
                    0x701_u32.to_le_bytes().to_vec()
                }
            };
            if send(&mut served, header, (command, 5), &answer).is_none() {
                return true;
            }
            if command != 6 {
                continue;
            }
            // TwinCAT sends each value once as soon as it is asked for, at an instant of its own.
            let early = 1000 - asked.len() as u64;
            let first = self.notification(&asked[asked.len() - 1..], &[self.next], early);
            let _ = send(&mut served, header, (8, 4), &first);
            if asked.len() < self.variables.len() {
                continue;
            }
            while self.next < self.script.samples {
                let end = (self.next + GATHERED).min(self.script.samples);
                let cut = self.script.cuts.range(self.next..end).next().copied();
                let end = cut.unwrap_or(end);
                let samples: Vec<usize> = (self.next..end)
                    .filter(|k| !self.script.lost.contains(k))
                    .collect();
                self.next = end;
                let sent = self.notification(&asked, &samples, 0);
                if send(&mut served, header, (8, 4), &sent).is_none() {
                    return true;
                }
                if let Some(cut) = cut {
                    self.script.cuts.remove(&cut);
                    return true;
                }
            }
            if self.script.gone {
                return false;
            }
        }
    }

    fn look_up(&self, name: &[u8]) -> Vec<u8> {
        let name = String::from_utf8_lossy(name).into_owned();
        let found = self.variables.iter().position(|own| own.name() == name);
        let Some(at) = found else {
            return 0x710_u32.to_le_bytes().to_vec();
        };
        let (kind, size) = self.variables[at].kind();
        let length = 30 + name.len() as u32 + 3;
        let numbers = [0, length, length, 0x4040, at as u32, size, kind, 0];
        let mut answer: Vec<u8> = numbers.iter().flat_map(|n: &u32| n.to_le_bytes()).collect();
        answer.extend_from_slice(&(name.len() as u16).to_le_bytes());
        answer.extend_from_slice(&[0; 4]);
        answer.extend_from_slice(name.as_bytes());
        answer.extend_from_slice(&[0; 3]);
        answer
    }

    /// Samples of variables, a stamp each, `early` ticks too early.
    fn notification(&self, variables: &[usize], samples: &[usize], early: u64) -> Vec<u8> {
        let mut data = (samples.len() as u32).to_le_bytes().to_vec();
        for sample in samples {
            let stamp = BEGIN + ticks(*sample, self.rate) - early;
            data.extend_from_slice(&stamp.to_le_bytes());
            data.extend_from_slice(&(variables.len() as u32).to_le_bytes());
            for variable in variables {
                let (bytes, _) = self.variables[*variable].value(*sample, *variable);
                data.extend_from_slice(&(100 + *variable as u32).to_le_bytes());
                data.extend_from_slice(&(bytes.len() as u32).to_le_bytes());
                data.extend_from_slice(&bytes);
            }
        }
        [&(data.len() as u32).to_le_bytes()[..], &data].concat()
    }
}

/// Sends a packet from the target of a request to its source.
fn send(
    served: &mut Served,
    request: &[u8],
    (command, flags): (u16, u16),
    data: &[u8],
) -> Option<()> {
    let packet = [
        &[0, 0],
        &(32 + data.len() as u32).to_le_bytes()[..],
        &request[8..16],
        &request[..8],
        &command.to_le_bytes(),
        &flags.to_le_bytes(),
        &(data.len() as u32).to_le_bytes(),
        &[0; 4],
        &request[28..32],
        data,
    ];
    served.stream.write_all(&packet.concat()).ok()
}
